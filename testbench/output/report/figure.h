#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace tessera {

/// One figure of a run. The JSON files, statistics.csv and report.txt are made from lists of these.
struct Figure {
    std::string group;  ///< what it belongs to: "host"; a part of another group is "group.part"
    std::string name;
    std::variant<std::uint64_t, std::int64_t, double, bool, std::string> value;
    std::string unit;
    std::string description;
    std::string row;          ///< in a table of its group: the unit, decision or quantity; empty: of the whole group
    std::uint64_t whole = 0;  ///< if not 0, report.txt shows the value in per cent of this
};

/// Appends the figures of one group, or of one row of its table.
class FigureGroup {
  public:
    FigureGroup(std::vector<Figure>& all, std::string group, std::string row = {})
        : all_(all), group_(std::move(group)), row_(std::move(row)) {}

    template <class Value>
    void add(std::string name, const Value& value, const char* unit, std::string description, std::uint64_t whole = 0) {
        Figure figure{group_, std::move(name), {}, unit, std::move(description), row_, whole};
        if constexpr (std::is_same_v<Value, bool>)
            figure.value = value;
        else if constexpr (std::is_floating_point_v<Value>)
            figure.value = static_cast<double>(value);
        else if constexpr (std::is_signed_v<Value>)
            figure.value = static_cast<std::int64_t>(value);
        else if constexpr (std::is_arithmetic_v<Value>)
            figure.value = static_cast<std::uint64_t>(value);
        else
            figure.value = std::string(value);
        all_.push_back(std::move(figure));
    }

  private:
    std::vector<Figure>& all_;
    std::string group_, row_;
};

}  // namespace tessera
