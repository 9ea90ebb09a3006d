#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <set>
#include <string>

#include "modules/datapath/registers.h"
#include "modules/device/generate.h"
#include "modules/device/records.h"
#include "modules/device/register_file.h"
#include "testbench/tests/support/expect_section.h"

// The register map: its properties in any design, and the files made from it.

using namespace tessera;
using datapath::Format;

namespace {

datapath::Registers narrow() {
    datapath::Registers registers;
    registers.formats.position = Format::make_signed(8, 4);
    registers.formats.normal = Format::make_signed(6, 4);
    registers.formats.texture = Format::make_unsigned(4, 2);
    registers.formats.screen = Format::make_signed(8, 2);
    return registers;
}

datapath::Registers wide() {
    datapath::Registers registers;
    registers.formats.normal = Format::make_signed(18, 16);
    registers.formats.highlight_tag = true;
    registers.formats.final_edges = true;
    registers.formats.height_test = datapath::HeightTest::rank;
    registers.formats.distances = true;
    registers.formats.bound_bits = 16;
    return registers;
}

void expect_sound(const std::vector<DeviceRegister>& map) {
    std::set<std::uint32_t> words;
    std::set<std::string> names;
    std::uint32_t last = 0;
    for (const DeviceRegister& r : map) {
        INFO(r.name);
        CHECK(names.insert(r.name).second);
        CHECK(r.offset % (4 * static_cast<std::uint32_t>(r.words)) == 0);
        CHECK((r.offset == 0 || r.offset > last));
        last = r.offset;
        for (int word = 0; word < r.words; ++word)
            CHECK(words.insert(r.offset + 4 * static_cast<std::uint32_t>(word)).second);
        CHECK(r.offset + 4 * static_cast<std::uint32_t>(r.words) <= register_bytes);
        CHECK((r.bits >= 1 && r.bits <= 32 * r.words));
        CHECK((r.bits == 64 || r.reset >> r.bits == 0));
        CHECK_FALSE(r.meaning.empty());
    }
}

}  // namespace

TEST_CASE("registers do not overlap, are aligned, and hold their reset values, in narrow and wide formats") {
    expect_sound(register_map({}, {}));
    expect_sound(register_map(narrow(), {}));
    expect_sound(register_map(wide(), {4096, 4096}));
}

TEST_CASE("a register has the same offset in every design") {
    std::map<std::string, std::pair<std::uint32_t, int>> places;
    std::set<std::string> of_every_design;
    for (const DeviceRegister& r : documented_registers()) {
        places[r.name] = {r.offset, r.words};
        if (std::string(r.only_with).empty())
            of_every_design.insert(r.name);
    }
    for (const datapath::Registers& design : {datapath::Registers{}, narrow(), wide()}) {
        std::size_t shared = 0;
        for (const DeviceRegister& r : register_map(design, {})) {
            INFO(r.name);
            CHECK(places.at(r.name) == std::make_pair(r.offset, r.words));
            shared += of_every_design.count(r.name);
        }
        CHECK(shared == of_every_design.size());
    }
}

TEST_CASE("every machine register can be written and reaches the machine, at its least and its greatest value") {
    RegisterFile file(wide(), {});
    for (const bool greatest : {false, true}) {
        for (const DeviceRegister& r : register_map(wide(), {})) {
            if (r.offset < offset::machine || r.access != RegisterAccess::read_write)
                continue;
            const std::uint64_t half = std::uint64_t{1} << (r.bits - 1);
            file.set(r.offset, r.is_signed ? (greatest ? half - 1 : half) : greatest ? ~std::uint64_t{0} : 0);
        }
        const datapath::Registers machine = file.machine();
        datapath::visit_registers(machine, [&](const datapath::Register& field, const auto& values) {
            INFO(field.name);
            const std::string name = field.name;
            if (name.find(".base") != std::string::npos)
                return;
            const std::int64_t half = field.bits == 64 ? 0 : std::int64_t{1} << (field.bits - 1);
            for (const std::int64_t value : values)
                if (field.kind == datapath::RegisterKind::signed_number)
                    CHECK(value == (greatest ? half - 1 : -half));
                else
                    CHECK(value == (greatest ? half - 1 + half : 0));
        });
    }
}

TEST_CASE("a register file returns the machine registers with which it was initialised") {
    datapath::Registers initial = wide();
    std::int64_t next = -3;
    datapath::describe_registers(initial, [&](const datapath::Register& field, auto&... values) {
        const auto set = [&](auto& value) {
            next = (next * 31 + 7) % 100;
            value = static_cast<std::decay_t<decltype(value)>>(field.kind == datapath::RegisterKind::choice ? next & 1
                                                               : field.kind == datapath::RegisterKind::unsigned_number
                                                                   ? std::abs(next) % (1 << std::min(field.bits, 6))
                                                                   : next);
        };
        (set(values), ...);
    });
    const datapath::Registers back = RegisterFile(initial, {}).machine();
    std::vector<std::int64_t> expected, found;
    const auto collect = [](std::vector<std::int64_t>& to) {
        return
            [&](const datapath::Register&, const auto& values) { to.insert(to.end(), values.begin(), values.end()); };
    };
    datapath::visit_registers(initial, collect(expected));
    datapath::visit_registers(back, collect(found));
    CHECK(expected == found);
    CHECK(back.height_table.columns == initial.covered.columns);  // a register, with a Rank Test
    datapath::Registers without = initial;
    without.formats.height_test = datapath::HeightTest::summed_height;
    CHECK(RegisterFile(without, {}).machine().height_table.columns == initial.map.width + 1);
    CHECK(back.normal_map.entry_bytes == 7);
}

TEST_CASE("a register ignores bits beyond its width, and a negative value reads sign-extended") {
    RegisterFile file({}, {});
    const std::uint32_t width = file.offset_of("map.width"), offset_x = file.offset_of("transform.row_x.offset");
    file.set_word(width, 0xffffffff);
    CHECK(file.word(width) == 0x1fff);
    file.set_word(offset_x, 5);
    file.set_word(offset_x + 4, 0x40000000);
    CHECK(file.word(offset_x) == 5);
    CHECK(file.word(offset_x + 4) == 0xc0000000);  // 63 bits: the highest is the sign
    CHECK(file.find(width + 1) == nullptr);
    CHECK(file.find(register_bytes) == nullptr);
    CHECK(file.find(~std::uint64_t{3}) == nullptr);
    CHECK(file.find(0x01c) == nullptr);
}

TEST_CASE("records: a written record is read back, and a value beyond its format is refused") {
    datapath::Registers registers;
    datapath::Triangle triangle;
    std::int32_t next = 1;
    for (datapath::Vertex& v : triangle.vertices) {
        v.position = {next, -next, INT32_MIN};
        v.normal = {16384, -16384, next};
        v.tangent = {-next, 0, 1};
        v.handedness = next % 2 == 0 ? std::int8_t{1} : std::int8_t{-1};
        v.texture = {1u << 24, static_cast<std::uint32_t>(next)};
        next += 1000;
    }
    std::array<unsigned char, base_triangle_bytes> bytes{};
    write_base_triangle(triangle, bytes.data());
    datapath::Triangle back;
    REQUIRE(read_base_triangle(bytes.data(), registers.formats, back));
    std::array<unsigned char, base_triangle_bytes> again{};
    write_base_triangle(back, again.data());
    CHECK(bytes == again);
    CHECK(bytes[36 + 48] == 0xff);  // handedness of the second vertex: its tenth word, -1
    const std::vector<std::pair<int, std::uint32_t>> bad{
        {3, 16385}, {4, 0xffffbfff}, {6, 1u << 20},        {9, 0},          {9, 2},
        {9, 257},   {9, 0xffff},     {10, (1u << 24) + 1}, {11, 0xffffffff}};
    for (const auto& [word, value] : bad) {
        INFO(word << ' ' << value);
        auto wrong = bytes;
        datapath::store_word(value, &wrong[static_cast<std::size_t>(4 * word + 96)]);
        CHECK_FALSE(read_base_triangle(wrong.data(), registers.formats, back));
    }
    registers.formats.position = Format::make_signed(24, 16);
    CHECK_FALSE(read_base_triangle(bytes.data(), registers.formats, back));
    for (const auto& [z, fits] : {std::pair{-(1 << 23), true}, {(1 << 23) - 1, true}, {1 << 23, false}}) {
        for (datapath::Vertex& v : triangle.vertices)
            v.position.z = z;
        write_base_triangle(triangle, bytes.data());
        CHECK(read_base_triangle(bytes.data(), registers.formats, back) == fits);
    }

    LitTriangle lit;
    lit.corners[1] = {{-5, 7, -1, true}, {3, 4}, 200};
    std::array<unsigned char, finished_triangle_bytes> record{};
    write_finished_triangle(lit, record.data());
    const LitTriangle read = read_finished_triangle(record.data());
    CHECK(read.corners[1].screen == lit.corners[1].screen);
    CHECK(read.corners[1].texture == lit.corners[1].texture);
    CHECK(read.corners[1].intensity == 200);
    CHECK_FALSE(read.corners[2].screen.in_front);
}

TEST_CASE("the generated files match the register map") {
    const std::vector<DeviceRegister> registers = documented_registers();
    for (const auto& [name, text] :
         std::map<std::string, std::string>{{"generated/tessera_registers.h", c_header(registers)},
                                            {"generated/tessera_registers.sv", systemverilog_package(registers)},
                                            {"generated/tessera_registers.json", registers_as_json(registers)},
                                            {"REGISTERS.md", registers_page(registers)}})
        testing::expect_section("modules/device/" + name, "", text);
}
