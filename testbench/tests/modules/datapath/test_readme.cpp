#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "modules/datapath/all_intermediates.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/registers.h"
#include "testbench/tests/support/count_members.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera::datapath;
using tessera::testing::count_members;

namespace {

const std::filesystem::path project = tessera::source_folder();
const std::filesystem::path folder = project / "modules/datapath";

std::string text_of(const std::filesystem::path& file) {
    std::string text = tessera::read_all(file);
    REQUIRE_FALSE(text.empty());
    return text;
}

/// The cells of each row of a Markdown table below `heading`, up to the next heading.
std::vector<std::vector<std::string>> rows_below(const std::string& heading) {
    std::istringstream lines(text_of(folder / "README.md"));
    std::vector<std::vector<std::string>> rows;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("## ", 0) == 0)
            inside = line == "## " + heading;
        if (!inside || line.rfind("| ", 0) != 0)
            continue;
        std::vector<std::string> cells;
        std::istringstream row(line.substr(1));
        for (std::string cell; std::getline(row, cell, '|');)
            cells.push_back(std::regex_replace(cell, std::regex("^ +| +$"), ""));
        rows.push_back(cells);
    }
    REQUIRE(rows.size() > 2);
    rows.erase(rows.begin(), rows.begin() + 2);  // header and separator
    return rows;
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
        found.insert((*at)[1]);
    return found;
}

/// Functions declared at the start of a line in the datapath's headers, with the header's name.
std::map<std::string, std::string> functions() {
    std::map<std::string, std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".h")
            continue;
        for (const std::string& name :
             matches(text_of(entry.path()),
                     R"((?:^|\n)(?:\[\[nodiscard\]\] )?(?:inline )?(?:constexpr |int )(?:[\w:<>, *]+? )?&?(\w+)\()"))
            names.emplace(name, entry.path().stem().string());
    }
    return names;
}

/// Functions of the model without hardware.
const std::set<std::string> without_hardware{"entry_bytes",
                                             "fits_formats",
                                             "packed_triangle_bytes",
                                             "packed_triangle_bits",
                                             "describe_base_vertex",
                                             "describe_displaced",
                                             "bits_for",
                                             "height_entry_bits",
                                             "rank_entry_bits",
                                             "ordering_bits",
                                             "curvature_threshold_bits",
                                             "mipmap_threshold_bits",
                                             "covered_texels",
                                             "store_word",
                                             "load_word",
                                             "make_reciprocal_seeds",
                                             "make_reciprocal_root_seeds",
                                             "integer_square_root",
                                             "wider",
                                             "signed_bits",
                                             "first_too_wide",
                                             "fits_every_format",
                                             "visit_intermediates"};

std::string in_code(const std::string& name) {
    return name.find(' ') == std::string::npos ? "`" + name + "`" : name;
}

}  // namespace

TEST_CASE("the datapath's README names every function of hardware in its headers, and no other") {
    const std::map<std::string, std::string> declared = functions();
    REQUIRE(declared.count("displace") == 1);
    REQUIRE(declared.count("tessellate") == 1);
    REQUIRE(declared.count("pack_triangle") == 1);
    const std::string readme = text_of(folder / "README.md");
    for (const auto& [name, header] : declared) {
        INFO(name);
        const bool of_the_model =
            without_hardware.count(name) == 1 || name.find("_multiplications") != std::string::npos;
        CHECK((readme.find("`" + name + "`") != std::string::npos) == !of_the_model);
    }
    for (const std::string& name : without_hardware) {
        INFO(name);
        CHECK(declared.count(name) == 1);
    }
    const auto has_test = [](const std::string& header) {
        const std::map<std::string, std::string> others{{"rectangle", "rectangles"}, {"triangle_pass", "tessellate"}};
        const std::string subject = others.count(header) == 0 ? header : others.at(header);
        return std::filesystem::exists(project / "testbench/tests/modules/datapath" / ("test_" + subject + ".cpp"));
    };
    for (const auto& row : rows_below("Functions")) {
        INFO(row.at(0));
        REQUIRE(row.size() == 6);
        for (const std::string& name : matches(row.at(0), "`(\\w+)`")) {
            INFO(name);
            REQUIRE(declared.count(name) == 1);
            CHECK(has_test(declared.at(name)));
        }
    }
}

TEST_CASE("the README has the widths of all intermediates in the default formats") {
    std::vector<std::vector<std::string>> expected;
    visit_intermediates(Formats{}, [&](const char* function, const auto& widths) {
        std::string bits;
        for (const Width& width : widths.all())
            bits += (bits.empty() ? "" : ", ") + std::to_string(width.bits);
        expected.push_back({in_code(function), bits});
    });
    const auto rows = rows_below("Intermediates");
    REQUIRE(rows.size() == expected.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        INFO(rows[k].at(0));
        CHECK(std::vector<std::string>{rows[k].at(0), rows[k].at(2)} == expected[k]);
        for (const std::string& name : matches(rows[k].at(1), "`(\\w+Widths)`"))
            for (const std::string& header : matches(rows[k].at(1), ", (\\w+\\.h)"))
                CHECK(text_of(folder / header).find("struct " + name + " ") != std::string::npos);
    }
}

namespace {

/// Visits the registers of every height test, each once.
template <class Visit>
void visit_every_register(Visit visit) {
    std::set<std::string> seen;
    for (std::size_t number = 0; number < height_tests().size(); ++number) {
        Registers registers;
        registers.formats.highlight_tag = true;
        registers.formats.height_test = static_cast<HeightTest>(number);
        registers.formats.bound_bits = 8;
        registers.formats.distances = true;
        visit_registers(registers, [&](const Register& field, const auto& values) {
            if (seen.insert(field.name).second)
                visit(field, values);
        });
    }
}

}  // namespace

TEST_CASE("the README lists the code's registers, with their widths in the default formats") {
    std::map<std::string, std::string> expected, found;
    visit_every_register([&](const Register& field, const auto& values) {
        expected[field.name] = (values.size() > 1 ? std::to_string(values.size()) + " x " : "") +
                               (field.kind == RegisterKind::signed_number ? "signed " : "") +
                               std::to_string(field.bits);
    });
    for (const auto& row : rows_below("Registers"))
        for (const std::string& name : matches(row.at(2), "`([^`]+)`"))
            CHECK(found.emplace(name, row.at(1)).second);
    CHECK(found == expected);
}

TEST_CASE("registers: the table has every parameter") {
    std::map<std::string, std::size_t> found;  // by group, the part before the first dot
    visit_every_register([&](const Register& field, const auto&) {
        const std::string name = field.name;
        if (name.find(".offset") == std::string::npos && name != "transform.view_distance_shift")
            ++found[name.substr(0, name.find('.'))];
    });
    const std::size_t height_thresholds = 5;  // of all height tests; one member
    CHECK(found["tests"] == count_members<TestParameters>() - 1 + height_thresholds);
    CHECK(found["displacement"] == count_members<DisplacementParameters>());
    CHECK(found["transform"] == count_members<TransformParameters>());
    CHECK(found["light"] == count_members<LightParameters>());
    CHECK(found["map"] == count_members<MapGeometry>());
}

TEST_CASE("registers: only a design with a Highlight Test has the test's registers") {
    const auto names = [](bool highlight) {
        Registers registers;
        registers.formats.highlight_tag = highlight;
        std::set<std::string> found;
        visit_registers(registers, [&](const Register& field, const auto&) { found.insert(field.name); });
        return found;
    };
    CHECK(names(false).count("tests.highlight_cosine") == 0);
    CHECK(names(true).size() == names(false).size() + 4);
}

TEST_CASE("registers: a test in place of the Summed Height Test adds its own registers, at the end") {
    const auto names = [](HeightTest test) {
        Registers registers;
        registers.formats.height_test = test;
        registers.formats.rank_bits = registers.formats.bound_bits = 6;
        std::vector<std::string> found;
        visit_registers(registers, [&](const Register& field, const auto&) { found.emplace_back(field.name); });
        return found;
    };
    std::vector<std::string> without = names(HeightTest::summed_height);
    without.erase(std::find(without.begin(), without.end(), "tests.summed_height_threshold"));
    for (const auto& [test, more] :
         {std::pair{HeightTest::rank, 4u}, {number_of<CurvatureTest>(), 3u}, {number_of<MipmapTest>(), 1u}}) {
        const std::vector<std::string> with = names(test);
        REQUIRE(with.size() == without.size() + more);
        CHECK(std::equal(without.begin(), without.end(), with.begin()));
    }
    const auto rank_registers = [](bool distances) {
        Registers registers;
        registers.formats.height_test = HeightTest::rank;
        registers.formats.rank_bits = registers.formats.bound_bits = 6;
        registers.formats.distances = distances;
        std::vector<std::string> found;
        visit_registers(registers, [&](const Register& field, const auto&) { found.emplace_back(field.name); });
        return found;
    };
    const std::vector<std::string> rank = rank_registers(false), in_view = rank_registers(true);
    REQUIRE(in_view.size() == rank.size() + 2);
    CHECK(std::equal(rank.begin(), rank.end(), in_view.begin()));
}

TEST_CASE("registers: a register holds only values that fit its bits") {
    const Register number{"", RegisterKind::unsigned_number, 9, ""};
    CHECK(holds(number, 0));
    CHECK(holds(number, 511));
    CHECK_FALSE(holds(number, 512));
    CHECK_FALSE(holds(number, -1));
    const Register with_sign{"", RegisterKind::signed_number, 26, ""};
    CHECK(holds(with_sign, 1 << 24));
    CHECK(holds(with_sign, -(1 << 25)));
    CHECK_FALSE(holds(with_sign, 1 << 25));
    CHECK_FALSE(holds(with_sign, -(1 << 25) - 1));
    CHECK(holds({"", RegisterKind::unsigned_number, 63, ""}, std::numeric_limits<std::int64_t>::max()));
}
