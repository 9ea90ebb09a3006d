#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "modules/sockets/packed_item.h"
#include "modules/timing/design.h"
#include "testbench/common/random.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/timed_modules.h"

// The items of the streams: each survives packing and unpacking, and modules/sockets/README.md lists its fields.

using namespace tessera;

namespace {

/// Sets each field to a random value of its width, often an extreme.
struct Filler {
    Random& random;

    std::int64_t field(const datapath::Field& field, std::int64_t) {
        const std::int64_t values = std::int64_t{1} << field.bits;
        const std::int64_t lowest = field.is_signed ? -values / 2 : 0;
        switch (random.integer(0, 3)) {
            case 0: return lowest;
            case 1: return lowest + values - 1;
            default: return random.integer(lowest, lowest + values - 1);
        }
    }
    std::uint32_t annotation(const char*, std::uint32_t) {
        return static_cast<std::uint32_t>(random.integer(0, 0xffffffff));
    }
};

/// The reference: writes fields in order, bit by bit.
struct BitByBit {
    PackedItem packed;
    std::size_t bits = 0, annotations = 0;

    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        for (int k = 0; k < field.bits; ++k, ++bits)
            packed.bytes.at(bits / 8) |= static_cast<unsigned char>((value >> k & 1) << bits % 8);
        return value;
    }
    std::uint32_t annotation(const char*, std::uint32_t value) { return packed.annotations.at(annotations++) = value; }
};

datapath::Formats narrow_formats() {
    datapath::Formats formats;
    formats.position = datapath::Format::make_signed(9, 4);
    formats.view_distance = datapath::Format::make_signed(17, 4);
    formats.normal = datapath::Format::make_signed(7, 5);
    formats.texture = datapath::Format::make_unsigned(11, 4);
    formats.screen = datapath::Format::make_signed(13, 2);
    formats.generation_bits = 3;
    formats.highlight_tag = true;
    return formats;
}

datapath::Formats widest_formats() {
    using Limits = datapath::FormatLimits;
    datapath::Formats formats;
    formats.position = datapath::Format::make_signed(Limits::position_bits.most, 16);
    formats.view_distance = datapath::Format::make_signed(Limits::position_bits.most, 16);
    formats.normal = datapath::Format::make_signed(Limits::normal_bits.most, 16);
    formats.texture =
        datapath::Format::make_unsigned(Limits::texture_integer.most + Limits::texture_fraction.most + 1, 12);
    formats.screen = datapath::Format::make_signed(Limits::screen_bits.most, 8);
    formats.generation_bits = Limits::generation_bits.most;
    formats.highlight_tag = formats.final_edges = formats.codes = formats.families = true;
    return formats;
}

datapath::Formats random_formats(Random& random) {
    const auto of = [&](datapath::FormatLimits::Range range) {
        return static_cast<int>(random.integer(range.least, range.most));
    };
    using Limits = datapath::FormatLimits;
    datapath::Formats formats;
    formats.position = datapath::Format::make_signed(of(Limits::position_bits), 0);
    formats.view_distance = datapath::Format::make_signed(of(Limits::position_bits), 0);
    formats.normal = datapath::Format::make_signed(of(Limits::normal_bits), 0);
    formats.texture = datapath::Format::make_unsigned(of(Limits::texture_integer) + 1, 0);
    formats.screen = datapath::Format::make_signed(of(Limits::screen_bits), 0);
    formats.displacement = datapath::Format::make_unsigned(of(Limits::displacement_bits), 0);
    formats.generation_bits = of(Limits::generation_bits);
    for (bool* option : {&formats.highlight_tag, &formats.final_edges, &formats.codes, &formats.families})
        *option = random.coin();
    return formats;
}

template <class Item>
void check_round_trips(const datapath::Formats& formats, int tag_bits, Random& random) {
    INFO(DescriptionOf<Item>::Type::name);
    for (int k = 0; k < 50; ++k) {
        Item item;
        Filler filler{random};
        describe_item(filler, item, formats, tag_bits);
        BitByBit expected, restored;
        describe_item(expected, item, formats, tag_bits);
        REQUIRE(expected.bits == item_bits<Item>(formats, tag_bits));
        PackedItem packed;
        REQUIRE(pack_item(item, formats, tag_bits, packed));
        REQUIRE(packed.bytes == expected.packed.bytes);
        const Item back = unpack_item<Item>(packed, formats, tag_bits);
        describe_item(restored, back, formats, tag_bits);
        REQUIRE(restored.packed.bytes == expected.packed.bytes);
        REQUIRE(restored.packed.annotations == expected.packed.annotations);
    }
}

/// A value of an item: its fields' names, widths and meaning.
struct Row {
    std::string name, bits, meaning;
    bool of_each;  ///< vertex or edge, of which the first represents all
};

/// Collects an item's values.
struct Table {
    std::vector<Row> rows;
    std::string components;
    datapath::Field last{};
    int alike = 0;  ///< fields of the same width that are not in the row yet

    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        if (field.index > 0)
            return value;
        const bool same_value = alike > 0 && std::string(field.name) == last.name && field.index == last.index;
        if (!same_value || field.bits != last.bits || field.is_signed != last.is_signed)
            finish_width();
        if (!same_value) {
            finish_value();
            rows.push_back({field.name, "", field.meaning, field.index == 0});
        }
        last = field;
        ++alike;
        if (*field.component != 0)
            components += (components.empty() ? "" : ", ") + std::string(field.component);
        return value;
    }
    std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }

    void finish_width() {
        if (alike > 0)
            rows.back().bits += (rows.back().bits.empty() ? "" : ", ") +
                                (alike > 1 ? std::to_string(alike) + " x " : "") + std::to_string(last.bits) +
                                (last.is_signed ? " signed" : "");
        alike = 0;
    }
    void finish_value() {
        if (!components.empty())
            rows.back().name += " (" + components + ")";
        components.clear();
    }
};

// Two groups of fields that many items begin with or contain.
struct TagOfPart {
    static constexpr const char* name = "tag of a part";
    PartTag tag;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
    }
};
struct OneVertex {
    static constexpr const char* name = "vertex";
    datapath::Vertex vertex;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_vertex(fields, item.vertex);
    }
};

/// The page's table of items. An item that contains all fields of one above has the name of that in their place.
class ItemPage {
  public:
    template <class Item>
    void add() {
        const datapath::Formats formats;
        const int tag = tag_bits(Design{});
        Table table;
        const Item item{};
        describe_item(table, item, formats, tag);
        table.finish_width();
        table.finish_value();
        const Shown shown{DescriptionOf<Item>::Type::name, std::to_string(item_bits<Item>(formats, tag)), table.rows};
        write("**" + shown.name + "**", shown.bits, "");
        for (std::size_t at = 0; at < shown.rows.size();) {
            const Shown* const part = found_in(shown.rows, at);
            const Row& row = shown.rows[at];
            const std::string each = row.of_each ? " of each" : "";
            if (part == nullptr)
                write(row.name + each, row.bits, row.meaning);
            else
                write("*" + part->name + "*" + (part->rows.front().of_each ? "" : each), part->bits, "");
            at += part == nullptr ? 1 : part->rows.size();
        }
        shown_.push_back(shown);
    }
    const std::string& text() const { return text_; }

  private:
    struct Shown {
        std::string name, bits;
        std::vector<Row> rows;
    };

    void write(const std::string& name, const std::string& bits, const std::string& meaning) {
        text_ += "| " + name + " | " + bits + " | " + meaning + (meaning.empty() ? "|\n" : " |\n");
    }

    /// The longest of those shown whose rows are those from `at` on; null: none.
    const Shown* found_in(const std::vector<Row>& rows, std::size_t at) const {
        const Shown* longest = nullptr;
        for (const Shown& part : shown_) {
            const std::size_t size = part.rows.size();
            if (size < 2 || at + size > rows.size() || (longest != nullptr && size <= longest->rows.size()))
                continue;
            bool same = true;
            for (std::size_t k = 0; k < size; ++k) {
                const Row &a = part.rows[k], &b = rows[at + k];
                const bool each_differs = a.of_each != b.of_each;
                same = same && a.name == b.name && a.bits == b.bits && a.meaning == b.meaning &&
                       each_differs == (part.rows[0].of_each != rows[at].of_each);
            }
            if (same)
                longest = &part;
        }
        return longest;
    }

    std::vector<Shown> shown_;
    std::string text_ = "| field | bits | meaning |\n| --- | --- | --- |\n";
};

}  // namespace

TEST_CASE("every stream's item survives packing and unpacking, in any formats") {
    Random random(11);
    std::vector<datapath::Formats> all{{}, narrow_formats(), widest_formats()};
    while (all.size() < 20)
        all.push_back(random_formats(random));
    for (const datapath::Formats& formats : all) {
        for (const int tag : {1, 6, 32}) {
            StreamItems::for_each([&](auto type) {
                using Item = typename decltype(type)::Item;
                datapath::Formats its_formats = formats;
                its_formats.families = formats.families && !std::is_same_v<Item, DecidedTriangle>;  // not of families
                check_round_trips<Item>(its_formats, tag, random);
            });
        }
    }
}

TEST_CASE("packing reports a value that its field cannot hold") {
    BasePoint point;
    const datapath::Formats formats = narrow_formats();
    PackedItem packed;
    point.p.y = 255;
    CHECK(pack_item(point, formats, 6, packed));
    point.p.y = 256;
    CHECK_FALSE(pack_item(point, formats, 6, packed));
    point.p.y = -257;
    CHECK_FALSE(pack_item(point, formats, 6, packed));
    point.p.y = 0;
    point.tag.triangle = 64;
    CHECK_FALSE(pack_item(point, formats, 6, packed));
}

// 32 * 3 for a position, 16 * 3 for a normal, 25 * 2 for a texture coordinate, 24 * 2 + 32 + 1 on the screen, 4 a part.
TEST_CASE("widths of items in the default formats, added up by hand") {
    const datapath::Formats formats;
    CHECK(item_bits<BasePoint>(formats, 6) == 6 + 4 + 96 + 48 + 50);
    CHECK(item_bits<ScreenPoint>(formats, 6) == 6 + 4 + 96 + 48 + 50 + 96 + 81);
    CHECK(item_bits<ViewResult>(formats, 6) == 6 + 4 + 1);
    CHECK(item_bits<datapath::Triangle>(formats, 6) == 1572);
    CHECK(item_bits<TriangleToLight>(formats, 6) == 3 * (81 + 48 + 50));
    CHECK(item_bits<QueueLevel>(formats, 6) == 1);
    CHECK(item_bits<Family>(formats, 6) == 6 + 6 * 522 + 2 + 3 + 3 + 2);
}

// One more bit in each field that lists tests: in split_by, and in each edge's tests.
TEST_CASE("widths of items in the default formats, with a Highlight Test") {
    datapath::Formats formats;
    formats.highlight_tag = true;
    CHECK(item_bits<datapath::Triangle>(formats, 6) == 1572 + 1);
    CHECK(item_bits<TestedEdge>(formats, 6) == 257 + 1);
    CHECK(item_bits<DecidedTriangle>(formats, 6) == 2991 + 1 + 3);
}

// A value outside the item's description, here the set of new vertices, is not transferred.
TEST_CASE("an output sends its items packed if the design requires it, in both modes") {
    using testing::Sink;
    CycleScheduler clock("clock", sc_core::sc_time(10, sc_core::SC_PS));
    testing::Caller unit(clock);
    datapath::Registers registers;
    Design packed, whole;
    packed.packed_streams = true;
    whole.packed_streams = false;
    struct Bench : sc_core::sc_module {
        StreamOutput<DecidedTriangle> through_wires{"through_wires"}, direct{"direct"};
        explicit Bench(const sc_core::sc_module_name& name) : sc_module(name) {}
    } bench("bench");
    Sink<DecidedTriangle> from_wires("from_wires", clock), from_direct("from_direct", clock);
    bench.through_wires.clocked_by({clock, registers, packed}, unit);
    bench.direct.clocked_by({clock, registers, whole}, unit);
    bench.through_wires.bind(from_wires.in);
    bench.direct.bind(from_direct.in);
    sc_core::sc_start(sc_core::SC_ZERO_TIME);

    DecidedTriangle item;
    item.origin = {12, 3};
    item.pass.split = 5;
    item.pass.new_vertices = 7;
    item.pass.triangle.vertices[1].normal.y = -9;
    sc_core::sc_time delay;
    bench.through_wires.transport(item, delay);
    bench.direct.transport(item, delay);
    CHECK(bench.through_wires.send(item));
    CHECK(bench.direct.send(item));
    sc_core::sc_start(sc_core::sc_time(10, sc_core::SC_PS));
    REQUIRE(from_wires.items.size() == 2);
    REQUIRE(from_direct.items.size() == 2);
    for (const DecidedTriangle& come : from_wires.items) {
        CHECK(come.origin.pass == 12);
        CHECK(come.origin.base == 3);
        CHECK(come.pass.split == 5);
        CHECK(come.pass.triangle.vertices[1].normal.y == -9);
        CHECK(come.pass.new_vertices == 0);
    }
    for (const DecidedTriangle& come : from_direct.items)
        CHECK(come.pass.new_vertices == 7);
    item.pass.triangle.vertices[2].generation = 16;  // of four bits
    for (const std::string& error : {testing::error_of([&] { bench.through_wires.send(item); }),
                                     testing::error_of([&] { bench.through_wires.transport(item, delay); })})
        CHECK_THAT(error, Catch::Contains("through_wires") && Catch::Contains("a value that does not fit its field"));
    bench.direct.transport(item, delay);
    CHECK(from_direct.items.back().pass.triangle.vertices[2].generation == 16);
}

// One triangle in Get Triangle; in Calculate New P, Displace Vertex and Transform one place at the input and 1, 7
// (including the map's cycle) and 20 register stages; one at Pass or Tessellate's input; and its 8 places.
TEST_CASE("a tag distinguishes all triangles between Get Triangle and Pass or Tessellate") {
    Design design;
    CHECK(triangles_ahead_of_parts(design) == 1 + (1 + 1) + (1 + 7) + (1 + 20) + 1);
    CHECK(tag_bits(design) == 6);  // 33, one offered, and 8
    design.timing.pass_or_tessellate.buffer = 30;
    CHECK(tag_bits(design) == 6);
    design.timing.pass_or_tessellate.buffer = 31;
    CHECK(tag_bits(design) == 7);
    design.timing.pass_or_tessellate.buffer = 0xffffff00u;
    CHECK(tag_bits(design) == 32);
    design.timing.pass_or_tessellate.buffer = 31;
    design.transform_pipelines = 2;
    CHECK(triangles_ahead_of_parts(design) == 33 + 20);
    CHECK(tag_bits_in_use(design) == 32);  // blocking transport
    design.transport = Transport::non_blocking;
    CHECK(tag_bits_in_use(design) == tag_bits(design));
}

TEST_CASE("the streams' README lists every item with its fields") {
    ItemPage page;
    page.add<TagOfPart>();
    page.add<OneVertex>();
    StreamItems::for_each([&](auto type) { page.add<typename decltype(type)::Item>(); });
    testing::expect_section("modules/sockets/README.md", "## Items\n\n", page.text());
}
