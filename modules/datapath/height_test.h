#pragma once
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string>

#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/rank_view.h"
#include "modules/datapath/reads.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// An edge, as a height test sees it.
struct HeightEdge {
    TexCoord t_i, t_j, t_ij;
    bool codes_known = false;              ///< with Formats::codes: both ends are displaced
    std::uint16_t code_i = 0, code_j = 0;  ///< then d of the ends
    EdgeInView ends{};                     ///< with Formats::distances
};

/// Most values of a HeightDecision.
inline constexpr std::size_t height_values = 7;

/// What a height test makes of an edge.
struct HeightDecision {
    bool asks = false;                                  ///< for a split
    std::uint16_t rank = 0;                             ///< by which the `greatest_rank` cut compares edges
    std::array<std::uint64_t, height_values> values{};  ///< what it was made from: HeightTestFunctions::values
};

/// A height test of a design: its table and its arithmetic. The unit (units/edge_tests/height_test.h), the device and the
/// testbench's models call these. Functions are pure: of the edge, the entries read for it and the registers.
class HeightTestFunctions {
  public:
    static constexpr unsigned most_latency = 1000000;
    static constexpr int first_free_feature = 13, last_feature = 15;  ///< of `feature`, for an added test

    /// One of HeightDecision::values, as in a waveform.
    struct Value {
        const char* name = nullptr;
        unsigned bits = 0;
    };
    /// The register of a threshold, one of TestParameters::height_thresholds.
    struct Threshold {
        const char* name = nullptr;  ///< "rank_threshold": register and job key tests.rank_threshold
        int bits = 0;                ///< at most 63; 0: designs of these formats lack the register
        bool is_signed = false;
        const char* meaning = "";
    };

    virtual ~HeightTestFunctions() = default;

    const char* name;       ///< "mipmap" for the Mipmap Test and its table; value of the key hardware.height_test
    const char* work = "";  ///< what it does with an edge, for the table of units in modules/README.md
    const char* arithmetic = "";
    unsigned latency = 1;      ///< cycles, after the last entry
    int feature = -1;          ///< its bit of the device's register `features`; -1: none
    bool rectangles = false;   ///< a request reads the corners of a rectangle, at most nine entries, from a
                               ///< memory with the timing of the Summed Height Table; otherwise one entry
    unsigned requests;         ///< exactly, at most 3, of an edge to the test's table, unless it reads codes or nothing
    unsigned codes = 0;        ///< entries of the displacement map that a short edge may read instead
    bool second_side = false;  ///< also codes of vertices not yet displaced: an on-chip map has a second side for it
    bool covers_more = false;  ///< its table may cover more texels than the map (CoveredTexels)
    bool may_read_nothing = false;              ///< it decides some edges without a read
    std::array<Value, height_values> values{};  ///< the last ones have no name: unused
    int compared = -1;  ///< number of the value that is compared with limit(); -1: another decision

    /// Names of its unit and its table, of their modules and in text.
    std::string unit() const { return std::string(name) + "_test"; }
    std::string table() const { return std::string(name) + "_table"; }
    std::string title() const { return capitalised(unit()); }

    /// Bits of an entry of the test's table, at most 64.
    virtual int entry_bits(const Formats& formats) const = 0;
    /// Columns and rows of the table, which follow from the other registers.
    virtual void shape(const Registers& registers, TableLayout& table) const = 0;
    /// Whether some edges read the displacement map in place of the table, through port 1.
    virtual bool reads_codes(const Formats&) const { return codes > 0; }
    /// In a test of the datapath: calls visit(name of a function, struct of its intermediates) for each.
    template <class Visit>
    static constexpr void visit_intermediates(const Formats&, const Visit&) {}
    /// Of one edge.
    virtual Multiplications multiplications(const Registers&) const { return {}; }
    /// At most two; the others have no name.
    virtual std::array<Threshold, 2> thresholds(const Formats& formats) const = 0;
    /// What the compared value must exceed. weight: of the edge, whatever the thresholds.
    virtual std::uint64_t limit(std::uint64_t /*weight*/, const TestParameters&) const { return 0; }
    virtual std::uint64_t weight(const HeightDecision&) const { return 1; }
    /// Number of values in a waveform: all that have a name, unless a design lacks the last ones.
    virtual unsigned traced(const Formats&) const {
        unsigned count = 0;
        while (count < values.size() && values[count].name != nullptr)
            ++count;
        return count;
    }

    /// Adds the entries that an edge needs, as declared above (units/edge_tests/declared_reads.h).
    virtual void reads(const HeightEdge& edge, const Registers& registers, Reads& reads) const = 0;
    /// entries: those, in their order; the others are not set. Sets members of `decision`, which is as constructed.
    virtual void decide(const HeightEdge& edge, const Entries& entries, const Registers& registers,
                        HeightDecision& decision) const = 0;

  protected:
    constexpr HeightTestFunctions(const char* its_name, unsigned most_requests)
        : name(its_name), requests(most_requests) {}

  private:
    /// "Mipmap Test" for "mipmap_test".
    static std::string capitalised(std::string words) {
        bool first = true;
        for (char& letter : words) {
            if (first)
                letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
            first = letter == '_';
            if (first)
                letter = ' ';
        }
        return words;
    }
};

}  // namespace tessera::datapath
