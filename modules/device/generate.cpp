#include "modules/device/generate.h"

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <tuple>
#include <utility>

#include "modules/datapath/height_tests.h"
#include "modules/device/records.h"

namespace tessera {

namespace {

const char* const made_by = "Generated from modules/device/register_map.cpp; do not edit.";

/// "tests.half_vector[0]" as TESTS_HALF_VECTOR_0.
std::string upper_case(const std::string& name) {
    std::string result;
    for (const char c : name) {
        if (c != ']')
            result += std::isalnum(static_cast<unsigned char>(c)) != 0
                          ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                          : '_';
    }
    return result;
}

std::string hex(std::uint64_t value, int digits) {
    std::ostringstream text;
    text << std::hex << std::setw(digits) << std::setfill('0') << value;
    return text.str();
}

const char* access_name(RegisterAccess access) {
    switch (access) {
        case RegisterAccess::read_only: return "ro";
        case RegisterAccess::read_write: return "rw";
        case RegisterAccess::command: return "command";
        case RegisterAccess::write_one_to_clear: return "w1c";
    }
    return "";
}

template <class Each>
void for_each_word(Each&& each) {
    datapath::Vertex vertex;
    LitTriangle::Corner corner;
    describe_base_vertex(vertex, [&](const char* name, auto&, bool is_signed, const char* meaning) {
        each(false, name, is_signed, meaning);
    });
    describe_finished_vertex(corner, [&](const char* name, auto&, bool is_signed, const char* meaning) {
        each(true, name, is_signed, meaning);
    });
}

/// Whether the register follows the other at once and differs from it in nothing but its name.
bool continues(const DeviceRegister& before, const DeviceRegister& r) {
    const auto facts = [](const DeviceRegister& it) {
        return std::tie(it.bits, it.words, it.is_signed, it.reset, it.access, it.while_busy, it.only_with, it.meaning);
    };
    return r.offset == before.offset + 4 * static_cast<std::uint32_t>(r.words) && facts(r) == facts(before);
}

/// "`map.width`, `map.height`"; an array as "`tests.half_vector[0..2]`".
std::string names_of(const std::vector<DeviceRegister>& registers) {
    std::string text;
    for (const DeviceRegister& r : registers) {
        const std::size_t bracket = r.name.find('[');
        if (bracket != std::string::npos && r.name[bracket + 1] != '0')
            continue;
        text += (text.empty() ? "`" : ", `") + r.name.substr(0, bracket);
        if (bracket != std::string::npos) {
            const std::string array = r.name.substr(0, bracket + 1);
            const auto elements = std::count_if(registers.begin(), registers.end(),
                                                [&](const DeviceRegister& it) { return it.name.rfind(array, 0) == 0; });
            text += "[0.." + std::to_string(elements - 1) + ']';
        }
        text += '`';
    }
    return text;
}

/// A row of the page's table of records.
struct RecordRow {
    bool finished, is_signed;
    int first, last;  ///< words
    std::string names, meaning;
};

/// struct tessera_base_vertex, or of the finished triangle.
std::string c_record(bool finished) {
    const std::string name = finished ? "finished" : "base";
    std::string text = "struct tessera_" + name + "_vertex {\n";
    for_each_word([&](bool of_finished, const char* word, bool is_signed, const std::string& meaning) {
        if (of_finished == finished)
            text += std::string("    ") + (is_signed ? "int32_t " : "uint32_t ") + word + ";" +
                    (meaning.empty() ? "" : "  /* " + meaning + " */") + "\n";
    });
    return text + "};\nstruct tessera_" + name + "_triangle {\n    struct tessera_" + name +
           "_vertex vertices[3];\n};\n";
}

}  // namespace

std::vector<DeviceRegister> documented_registers() {
    datapath::Registers registers;
    registers.formats.highlight_tag = true;
    registers.formats.distances = true;
    registers.formats.rank_bits = registers.formats.bound_bits = 16;
    std::vector<DeviceRegister> all = register_map({}, {});
    for (std::size_t kind = 1; kind < datapath::height_tests().size(); ++kind) {
        registers.formats.height_test = static_cast<datapath::HeightTest>(kind);
        for (DeviceRegister& made : register_map(registers, {}))
            if (std::none_of(all.begin(), all.end(), [&](const DeviceRegister& r) { return r.name == made.name; }))
                all.push_back(std::move(made));
    }
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; });
    return all;
}

std::string c_header(const std::vector<DeviceRegister>& registers) {
    std::ostringstream text;
    text
        << "#pragma once\n/* clang-format off */\n/* NOLINTBEGIN(readability-identifier-naming,modernize-deprecated-headers): C's */\n/* Registers and records of tessera's device.\n"
           " * "
        << made_by
        << "\n"
           " * Offsets are the same in every design; widths are those of the default formats. */\n"
           "#include <stdint.h>\n\n"
           "/* Offsets in bytes. In a two-word register the lower word comes first. */\n";
    for (const DeviceRegister& r : registers)
        text << "#define TESSERA_" << upper_case(r.name) << " 0x" << hex(r.offset, 3) << "u\n";
    text << "#define TESSERA_REGISTER_BYTES 0x" << hex(register_bytes, 3) << "u\n\n/* Bits of control registers. */\n";
    for (const RegisterBit& bit : register_bits())
        text << "#define TESSERA_" << upper_case(bit.register_name) << "_" << upper_case(bit.name) << " (1u << "
             << bit.bit << ")  /* " << bit.meaning << " */\n";
    text << "\n/* Register `error`. */\nenum tessera_error {\n";
    for (const ErrorMeaning& error : error_meanings)
        text << "    TESSERA_ERROR_" << upper_case(error.name) << " = " << static_cast<int>(error.error) << ",  /* "
             << error.meaning << " */\n";
    text << "};\n#define TESSERA_ERRORS " << error_meanings.size() << "\n#define TESSERA_ERROR_TEXTS";
    for (const ErrorMeaning& error : error_meanings)
        text << " \\\n    \"" << error.meaning << (&error == &error_meanings.back() ? "\"" : "\",");
    text
        << "\n\n/* Records in bus memory: little-endian words. */\n"
        << c_record(false) << c_record(true)
        << "\n/* X(name, offset, bits, words, is signed, writable) for every register. */\n#define TESSERA_REGISTER_LIST(X)";
    for (const DeviceRegister& r : registers)
        text << " \\\n    X(" << upper_case(r.name) << ", 0x" << hex(r.offset, 3) << "u, " << r.bits << ", " << r.words
             << ", " << (r.is_signed ? 1 : 0) << ", " << (r.access == RegisterAccess::read_only ? 0 : 1) << ")";
    text
        << "\n\n/* Numbers of the registers: their positions in that list. */\nenum tessera_register {\n"
           "#define TESSERA_NUMBER(name, offset, bits, words, is_signed, writable) TESSERA_REGISTER_##name,\n"
           "    TESSERA_REGISTER_LIST(TESSERA_NUMBER)\n#undef TESSERA_NUMBER\n"
           "    TESSERA_REGISTERS  /* number of registers */\n};\n/* NOLINTEND(readability-identifier-naming,modernize-deprecated-headers) */\n";
    return text.str();
}

std::string systemverilog_package(const std::vector<DeviceRegister>& registers) {
    std::ostringstream text;
    text << "// Registers of tessera's device. " << made_by << "\npackage tessera_registers;\n\n"
         << "  // Offset in bytes, width in bits in the default formats, reset value.\n";
    for (const DeviceRegister& r : registers) {
        const std::string name = upper_case(r.name);
        text << "  localparam logic [11:0] " << name << " = 12'h" << hex(r.offset, 3) << ";\n"
             << "  localparam int unsigned " << name << "_BITS = " << r.bits << ";\n"
             << "  localparam logic [" << r.bits - 1 << ":0] " << name << "_RESET = " << r.bits << "'h"
             << hex(r.reset, 1) << ";\n";
    }
    text << "\n  // Bits of control registers.\n";
    for (const RegisterBit& bit : register_bits())
        text << "  localparam int unsigned " << upper_case(bit.register_name) << "_" << upper_case(bit.name)
             << "_BIT = " << bit.bit << ";  // " << bit.meaning << "\n";
    text << "\n  // Register error.\n  typedef enum logic [3:0] {\n";
    for (const ErrorMeaning& error : error_meanings)
        text << "    ERROR_" << upper_case(error.name) << " = 4'd" << static_cast<int>(error.error)
             << (&error == &error_meanings.back() ? "" : ",") << "  // " << error.meaning << "\n";
    text << "  } error_e;\n\n  // Words of a vertex's record in bus memory.\n";
    int word = 0;
    bool before = false;
    for_each_word([&](bool finished, const char* name, bool, const char*) {
        word = finished != before ? 0 : word;
        before = finished;
        text << "  localparam int unsigned " << (finished ? "FINISHED_" : "BASE_") << upper_case(name)
             << "_WORD = " << word++ << ";\n";
    });
    text << "\nendpackage\n";
    return text.str();
}

std::string registers_as_json(const std::vector<DeviceRegister>& registers) {
    std::ostringstream text;
    text << "{\n  \"generated\": \"" << made_by << "\",\n  \"bytes\": " << register_bytes << ",\n  \"registers\": [\n";
    for (const DeviceRegister& r : registers) {
        text << "    {\"name\": \"" << r.name << "\", \"offset\": " << r.offset << ", \"bits\": " << r.bits
             << ", \"words\": " << r.words << ", \"signed\": " << (r.is_signed ? "true" : "false")
             << ", \"reset\": \"0x" << hex(r.reset, 1) << "\", \"access\": \"" << access_name(r.access)
             << "\", \"while_busy\": " << (r.while_busy ? "true" : "false") << ", \"only_with\": \"" << r.only_with
             << "\", \"meaning\": \"" << r.meaning << "\"}" << (&r == &registers.back() ? "\n" : ",\n");
    }
    text << "  ],\n  \"bits\": [\n";
    const std::vector<RegisterBit> bits = register_bits();
    for (const RegisterBit& bit : bits)
        text << "    {\"register\": \"" << bit.register_name << "\", \"name\": \"" << bit.name
             << "\", \"bit\": " << bit.bit << ", \"meaning\": \"" << bit.meaning << "\"}"
             << (&bit == &bits.back() ? "\n" : ",\n");
    text << "  ],\n  \"errors\": [\n";
    for (const ErrorMeaning& error : error_meanings)
        text << "    {\"value\": " << static_cast<int>(error.error) << ", \"name\": \"" << error.name
             << "\", \"meaning\": \"" << error.meaning << "\"}" << (&error == &error_meanings.back() ? "\n" : ",\n");
    text << "  ],\n  \"base_triangle_bytes\": " << base_triangle_bytes
         << ",\n  \"finished_triangle_bytes\": " << finished_triangle_bytes << "\n}\n";
    return text.str();
}

std::string registers_page(const std::vector<DeviceRegister>& registers) {
    std::ostringstream text;
    text
        << "# The device's registers\n\n"
        << made_by
        << "\n\nOffsets are in bytes and the same in every design. Widths and reset values are those of the default\n"
           "design; for registers that it lacks, those of a design that has them; *(with a Rank Test)*: only a design with that test has the\n"
           "register. A register of more than 32 bits has a second word, which follows the lower one. Bits beyond the width read as 0, in a\n"
           "signed register as copies of the sign bit, and are ignored in writes. `ro`: a write is refused.\n"
           "`rw`: refused while a frame is under way, unless marked *. `command`: writing 1 executes the command, reads return 0. `w1c`: writing 1\n"
           "clears the bit. Registers in one row follow one another.\n\n"
           "| offset | register | bits | access | reset | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
    for (auto first = registers.begin(), next = first; first != registers.end(); first = next) {
        for (++next; next != registers.end() && continues(*std::prev(next), *next);)
            ++next;
        const DeviceRegister &r = *first, &last = *std::prev(next);
        text << "| 0x" << hex(r.offset, 3) << (r.offset == last.offset ? "" : " to 0x" + hex(last.offset, 3)) << " | "
             << names_of({first, next}) << " | " << (r.is_signed ? "signed " : "") << r.bits << " | "
             << access_name(r.access) << (r.while_busy ? "*" : "") << " | " << (r.reset < 10 ? "" : "0x")
             << hex(r.reset, 1) << " | " << r.meaning
             << (r.only_with.empty() ? std::string() : std::string(" (with a ") + r.only_with + ")") << " |\n";
    }
    text << "\n## Bits\n\n| register | bit | name | meaning |\n| --- | --- | --- | --- |\n";
    for (const RegisterBit& bit : register_bits())
        text << "| `" << bit.register_name << "` | " << bit.bit << " | `" << bit.name << "` | " << bit.meaning
             << " |\n";
    text
        << "\n## Errors\n\nValues of register `error`; after the semicolon, the contents of `error_address`.\n\n| value | name | meaning |\n"
           "| --- | --- | --- |\n";
    for (const ErrorMeaning& error : error_meanings)
        text << "| " << static_cast<int>(error.error) << " | `" << error.name << "` | " << error.meaning << " |\n";
    text << "\n## Records\n\nLittle-endian words, three vertices one after another: " << base_triangle_bytes
         << " bytes per base triangle, " << finished_triangle_bytes << " per\nfinished one, in all formats.\n\n"
         << "| record | word | name | meaning |\n| --- | --- | --- | --- |\n";
    std::vector<RecordRow> rows;  // words without a meaning of their own are in the row of the one before
    for_each_word([&](bool finished, const char* name, bool is_signed, const char* meaning) {
        const bool starts = rows.empty() || rows.back().finished != finished;
        const int word = starts ? 0 : rows.back().last + 1;
        if (starts || *meaning != 0 || rows.back().is_signed != is_signed)
            rows.push_back({finished, is_signed, word, word, "", meaning});
        rows.back().last = word;
        rows.back().names += (rows.back().names.empty() ? "`" : ", `") + std::string(name) + "`";
    });
    for (const RecordRow& row : rows)
        text << "| " << (row.finished ? "finished" : "base") << " | " << row.first
             << (row.first == row.last ? "" : " to " + std::to_string(row.last)) << " | " << row.names
             << (row.is_signed ? ", signed" : "") << " | " << row.meaning << " |\n";
    return text.str();
}

}  // namespace tessera
