#include "modules/device/register_map.h"

#include <algorithm>
#include <stdexcept>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/registers.h"
#include "modules/device/records.h"

namespace tessera {

namespace {

using datapath::Format;
using datapath::FormatLimits;
using datapath::Formats;

std::uint64_t packed(const Format& format) {
    return static_cast<std::uint64_t>(format.bits) | static_cast<std::uint64_t>(format.fraction) << 8;
}

unsigned feature_bit(const Formats& f) {
    const int bit = functions_of(f.height_test).feature;
    return bit < 0 ? 0 : 1u << bit;
}

std::uint64_t features(const Formats& f) {
    return (f.highlight_tag ? 1u : 0u) | (f.final_edges ? 2u : 0u) | (f.codes ? 4u : 0u) | (f.families ? 8u : 0u) |
           (f.filter == datapath::MapFilter::bilinear ? 16u : 0u) | feature_bit(f) | (f.distances ? 128u : 0u) |
           static_cast<std::uint64_t>(f.generation_bits) << 8;
}

std::uint64_t entry_sizes(const Formats& f) {
    return std::uint64_t{datapath::entry_bytes(f.displacement.bits)} |
           std::uint64_t{datapath::entry_bytes(3 * f.normal.bits)} << 8 |
           std::uint64_t{datapath::entry_bytes(datapath::height_entry_bits(f))} << 16;
}

std::vector<DeviceRegister> control_registers(const Formats& f, const LargestMap& largest) {
    constexpr RegisterAccess ro = RegisterAccess::read_only, rw = RegisterAccess::read_write,
                             w1c = RegisterAccess::write_one_to_clear;
    const char* const table = "address of the table in bus memory";
    const char* const format = "bits 7 to 0: width; bits 15 to 8: fraction bits";
    // name, offset, bits, words, signed, reset value, access, while busy, always present, meaning
    return {
        {"id", offset::id, 32, 1, false, 0x53534554, ro, false, "", "the letters TESS"},
        {"version", offset::version, 32, 1, false, 0x00010000, ro, false, "", "version of this register map: 1.0"},
        {"control", offset::control, 2, 1, false, 0, RegisterAccess::command, true, "", "start, reset"},
        {"status", offset::status, 4, 1, false, 0, ro, false, "", "busy, done, error, resetting"},
        {"interrupt", offset::interrupt, 2, 1, false, 0, w1c, true, "", "pending: done, error"},
        {"interrupt_enable", offset::interrupt_enable, 2, 1, false, 0, rw, true, "",
         "the interrupt output is high while a bit is set here and in interrupt"},
        {"error", offset::error, 4, 1, false, 0, ro, false, "", "why the last frame was refused or stopped"},
        {"error_address", offset::error_address, 64, 2, false, 0, ro, false, "",
         "address of the error: a bus address or a register's offset"},
        {"fetch", offset::fetch, 3, 1, false, 7, rw, false, "", "tables that a frame fetches before it begins"},
        {"displacement_map.address", offset::displacement_map_address, 64, 2, false, 0, rw, false, "", table},
        {"normal_map.address", offset::normal_map_address, 64, 2, false, 0, rw, false, "", table},
        {"summed_height_table.address", offset::summed_height_table_address, 64, 2, false, 0, rw, false, "", table},
        {"triangles.address", offset::triangles_address, 64, 2, false, 0, rw, false, "",
         "address of the base triangles' records in bus memory"},
        {"triangles.count", offset::triangles_count, 32, 1, false, 0, rw, false, "", "number of base triangles"},
        {"triangles.sent", offset::triangles_sent, 32, 1, false, 0, ro, false, "",
         "base triangles of this frame sent to the machine"},
        {"triangles.finished", offset::triangles_finished, 32, 1, false, 0, ro, false, "",
         "finished triangles of this frame, including culled ones, modulo 2^32"},
        {"ring.address", offset::ring_address, 64, 2, false, 0, rw, false, "",
         "address of the output ring in bus memory"},
        {"ring.size", offset::ring_size, 31, 1, false, 0, rw, false, "", "capacity in records"},
        {"ring.write_index", offset::ring_write_index, 32, 1, false, 0, ro, false, "",
         "records of this frame written, modulo 2^32"},
        {"ring.read_index", offset::ring_read_index, 32, 1, false, 0, rw, true, "",
         "records of this frame read by software, modulo 2^32; must not move back or pass the write index"},
        {"format.position", 0x080, 16, 1, false, packed(f.position), ro, false, "", format},
        {"format.normal", 0x084, 16, 1, false, packed(f.normal), ro, false, "", format},
        {"format.texture", 0x088, 16, 1, false, packed(f.texture), ro, false, "", format},
        {"format.displacement", 0x08c, 16, 1, false, packed(f.displacement), ro, false, "", format},
        {"format.summed_height", 0x090, 16, 1, false, packed(f.summed_height), ro, false, "", format},
        {"format.screen", 0x094, 16, 1, false, packed(f.screen), ro, false, "", format},
        {"features", 0x098, 16, 1, false, features(f), ro, false, "",
         "features of the design; bits 11 to 8: width of a generation"},
        {"largest_map", 0x09c, 32, 1, false, largest.width | std::uint64_t{largest.height} << 16, ro, false, "",
         "largest map: bits 15 to 0: columns; bits 31 to 16: rows"},
        {"entry_bytes", 0x0a0, 24, 1, false, entry_sizes(f), ro, false, "",
         "bytes of an entry: bits 7 to 0: displacement map; bits 15 to 8: normal map; bits 23 to 16: Summed Height Table or the table in its place"},
        {"record_bytes", 0x0a4, 32, 1, false, base_triangle_bytes | std::uint64_t{finished_triangle_bytes} << 16, ro,
         false, "", "bytes of a record: bits 15 to 0: base triangle; bits 31 to 16: finished triangle"},
    };
}

/// Registers in the formats in which each has its largest width.
datapath::Registers widest() {
    datapath::Registers registers;
    Formats& f = registers.formats;
    f.normal = Format::make_signed(FormatLimits::normal_bits.most, FormatLimits::normal_fraction.most);
    f.position = Format::make_signed(FormatLimits::position_bits.most, 0);
    f.screen = Format::make_signed(FormatLimits::screen_bits.most, 0);
    f.summed_height = Format::make_unsigned(FormatLimits::summed_height_bits.most, 0);
    f.rank_bits = FormatLimits::rank_bits.most;
    f.bound_bits = FormatLimits::bound_bits.most;
    return registers;
}

/// Calls visit(register, values) for each register of a design of this kind, in the widest formats.
template <class Visit>
void visit_widest(datapath::HeightTest kind, bool highlight, bool distances, Visit&& visit) {
    datapath::Registers registers = widest();
    registers.formats.distances = distances;
    registers.formats.height_test = kind;
    registers.formats.highlight_tag = highlight;
    datapath::visit_registers(registers, visit);
}

bool has_register(datapath::HeightTest kind, bool highlight, bool distances, const std::string& name) {
    bool found = false;
    visit_widest(kind, highlight, distances,
                 [&](const datapath::Register& field, const auto&) { found = found || name == field.name; });
    return found;
}

/// The test that a register belongs to; empty if every design has the register. kind: that of a design that has it.
std::string test_of(const std::string& name, datapath::HeightTest kind) {
    bool in_all = true;
    for (std::size_t number = 0; number < datapath::height_tests().size(); ++number)
        in_all = in_all && has_register(static_cast<datapath::HeightTest>(number), false, false, name);
    if (in_all)
        return "";
    if (!has_register(kind, false, true, name))
        return "Highlight Test";
    return has_register(kind, false, false, name) ? functions_of(kind).title() : "view-dependent Rank Test";
}

struct RegisterPlace {
    std::string register_name;
    std::string name;  ///< name of one value of the register
    std::uint32_t offset;
    int words;
    std::string only_with;
};

/// The places of the machine's registers, over all designs.
std::vector<RegisterPlace> machine_places() {
    std::vector<RegisterPlace> places;
    std::uint32_t next = offset::machine;
    for (std::size_t number = 0; number < datapath::height_tests().size(); ++number) {
        const auto kind = static_cast<datapath::HeightTest>(number);
        visit_widest(kind, true, true, [&](const datapath::Register& field, const auto& values) {
            const std::string name = field.name;
            if (number > 0 && has_register(datapath::HeightTest::summed_height, true, false, name))
                return;
            for (std::size_t k = 0; k < values.size(); ++k) {
                const int words = field.bits > 32 ? 2 : 1;
                const std::uint32_t at = words == 2 ? (next + 7) / 8 * 8 : next;
                places.push_back({name, name + (values.size() == 1 ? std::string() : "[" + std::to_string(k) + "]"), at,
                                  words, test_of(name, kind)});
                next = at + 4 * static_cast<std::uint32_t>(words);
            }
        });
    }
    return places;
}

}  // namespace

std::vector<RegisterBit> register_bits() {
    std::vector<RegisterBit> bits(control_bits.begin(), control_bits.end());
    for (const datapath::HeightTestFunctions* const test : datapath::height_tests())
        if (test->feature >= 0)
            bits.push_back({"features", test->unit(), test->feature,
                            "a " + test->title() + " in place of the Summed Height Test"});
    const auto features = std::find_if(
        bits.begin(), bits.end(), [](const RegisterBit& bit) { return bit.register_name == std::string("features"); });
    std::sort(features, bits.end(), [](const RegisterBit& a, const RegisterBit& b) { return a.bit < b.bit; });
    return bits;
}

std::vector<DeviceRegister> register_map(const datapath::Registers& reset, const LargestMap& largest) {
    std::vector<DeviceRegister> map = control_registers(reset.formats, largest);
    const std::vector<RegisterPlace> places = machine_places();
    auto place = places.begin();
    datapath::visit_registers(reset, [&](const datapath::Register& field, const auto& values) {
        const std::string name = field.name;
        const bool base = name.find(".base") != std::string::npos;
        while (place != places.end() && place->register_name != name)
            ++place;
        if (place == places.end())
            throw std::logic_error("the device has no place for the register " + name);
        for (const std::int64_t value : values) {
            const std::uint64_t mask = field.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.bits) - 1;
            map.push_back({place->name, place->offset, field.bits, place->words,
                           field.kind == datapath::RegisterKind::signed_number,
                           static_cast<std::uint64_t>(value) & mask,
                           base ? RegisterAccess::read_only : RegisterAccess::read_write, false, place->only_with,
                           base ? "base address of the table in the device's own table memory" : field.meaning});
            ++place;
        }
    });
    return map;
}

}  // namespace tessera
