#include "testbench/output/report/figures_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tessera {

namespace {

constexpr std::size_t widest_value = 32;  // longer ones have a line of their own

using Figures = std::vector<const Figure*>;

struct ValueText {
    double whole;

    std::string operator()(const std::string& value) const { return value; }
    std::string operator()(bool value) const { return value ? "yes" : "no"; }
    template <class Number>
    std::string operator()(Number value) const {
        if (whole > 0)
            return fmt::format("{:.2f}", 100 * static_cast<double>(value) / whole);
        return std::is_floating_point_v<Number> ? fmt::format("{:.6g}", value) : fmt::format("{}", value);
    }
};

std::string value_text(const Figure& figure) {
    return std::visit(ValueText{static_cast<double>(figure.whole)}, figure.value);
}

std::string unit_text(const Figure& figure) {
    return figure.whole > 0 ? fmt::format("% of {} {}", figure.whole, figure.unit) : figure.unit;
}

bool is_text(const Figure& figure) {
    return std::holds_alternative<std::string>(figure.value);
}

/// The values of `key` in the order in which they first appear.
std::vector<std::string> distinct(const Figures& figures, std::string Figure::*key) {
    std::vector<std::string> all;
    for (const Figure* figure : figures)
        if (std::find(all.begin(), all.end(), figure->*key) == all.end())
            all.push_back(figure->*key);
    return all;
}

Figures with(const Figures& figures, std::string Figure::*key, const std::string& value) {
    Figures found;
    std::copy_if(figures.begin(), figures.end(), std::back_inserter(found),
                 [&](const Figure* figure) { return figure->*key == value; });
    return found;
}

std::string line(std::string text) {
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
}

std::string indented(const std::string& lines) {
    std::string text = "    ";
    for (const char c : lines)
        text += c == '\n' ? std::string("\n    ") : std::string(1, c);
    return line(text);
}

std::string list_text(const Figures& figures) {
    std::size_t names = 0, values = 0;
    const auto value_and_unit = [](const Figure& figure) { return value_text(figure) + " " + unit_text(figure); };
    for (const Figure* figure : figures) {
        names = std::max(names, figure->name.size());
        if (const std::size_t size = value_and_unit(*figure).size(); size <= widest_value)
            values = std::max(values, size);
    }
    std::string text;
    for (const Figure* figure : figures) {
        const std::string value = value_and_unit(*figure);
        if (value.size() <= widest_value)
            text += line(fmt::format("  {:<{}}  {:<{}}  {}", figure->name, names, value, values, figure->description));
        else
            text += line(fmt::format("  {:<{}}  {}", figure->name, names, figure->description)) + indented(value);
    }
    return text;
}

/// A row for each Figure::row. Figures that most rows lack follow at the row's end, by name.
std::string table_text(const Figures& figures) {
    const std::vector<std::string> rows = distinct(figures, &Figure::row);
    struct Column {
        std::string name;
        std::size_t width;
        bool left;
    };
    std::vector<Column> columns;
    for (const std::string& name : distinct(figures, &Figure::name)) {
        const Figures cells = with(figures, &Figure::name, name);
        Column column{name, name.size(), is_text(*cells.front())};
        for (const Figure* cell : cells)
            column.width = std::max(column.width, value_text(*cell).size());
        if (2 * cells.size() >= rows.size())
            columns.push_back(column);
    }
    std::size_t names = 0;
    for (const std::string& row : rows)
        names = std::max(names, row.size());
    const auto cell = [](const Column& column, const std::string& value) {
        return column.left ? fmt::format("  {:<{}}", value, column.width)
                           : fmt::format("  {:>{}}", value, column.width);
    };
    std::string text = fmt::format("  {:<{}}", "", names);
    for (const Column& column : columns)
        text += cell(column, column.name);
    text = line(text);
    for (const std::string& row : rows) {
        Figures left = with(figures, &Figure::row, row);
        std::string words = fmt::format("  {:<{}}", row, names);
        for (const Column& column : columns) {
            const auto it = std::find_if(left.begin(), left.end(),
                                         [&](const Figure* figure) { return figure->name == column.name; });
            words += cell(column, it == left.end() ? "" : value_text(**it));
            if (it != left.end())
                left.erase(it);
        }
        for (const Figure* figure : left)
            words += fmt::format("  {} {}", figure->name, value_text(*figure));
        text += line(words);
    }
    std::set<std::string> explained;
    Figures columns_meanings;
    for (const Figure* figure : figures)
        if (!figure->description.empty() && explained.insert(figure->name).second &&
            explained.insert(unit_text(*figure) + "; " + figure->description).second)
            columns_meanings.push_back(figure);
    std::size_t widest = 0;
    for (const Figure* figure : columns_meanings)
        widest = std::max(widest, figure->name.size());
    for (const Figure* figure : columns_meanings) {
        const std::string unit = unit_text(*figure);
        text += fmt::format("    {:<{}}  {}{}{}\n", figure->name, widest, unit, unit.empty() ? "" : ": ",
                            figure->description);
    }
    return text;
}

}  // namespace

std::string figures_text(const std::vector<Figure>& figures) {
    Figures all;
    for (const Figure& figure : figures)
        if (!is_text(figure) || !std::get<std::string>(figure.value).empty())
            all.push_back(&figure);
    std::string text;
    for (const std::string& group : distinct(all, &Figure::group)) {
        const Figures members = with(all, &Figure::group, group);
        const Figures list = with(members, &Figure::row, "");
        Figures table;
        std::copy_if(members.begin(), members.end(), std::back_inserter(table),
                     [](const Figure* figure) { return !figure->row.empty(); });
        text += (text.empty() ? "" : "\n") + group + "\n" + list_text(list) + (table.empty() ? "" : table_text(table));
    }
    return text;
}

}  // namespace tessera
