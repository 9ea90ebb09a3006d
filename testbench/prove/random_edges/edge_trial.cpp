#include "testbench/prove/random_edges/edge_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "testbench/prove/random_edges/random_machine.h"

namespace tessera {

namespace {

using datapath::TrianglePass, datapath::Vertex;

std::string text_of(const char* name, const Vertex& v) {
    return fmt::format(
        "\n  {}: P ({}, {}, {}), N ({}, {}, {}), T ({}, {}, {}), handedness {}, t ({}, {}), generation {}, "
        "P' ({}, {}, "
        "{}), N' ({}, {}, {}), P's ({}, {}), w {}, {}",
        name, v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z, v.tangent.x, v.tangent.y,
        v.tangent.z, int{v.handedness}, v.texture.u, v.texture.v, int{v.generation}, v.displaced.x, v.displaced.y,
        v.displaced.z, v.displaced_normal.x, v.displaced_normal.y, v.displaced_normal.z, v.screen.x, v.screen.y,
        v.screen.w, v.screen.in_front ? "in front" : "behind");
}

class Trial {
  public:
    explicit Trial(std::uint64_t seed) : random_(seed) {}

    EdgeTrial run(std::uint64_t edges);

  private:
    void try_machine(RandomMachine& made, std::uint64_t edges);
    void try_edge(EdgeMachine& machine, const DirectEdge& direct, const Vertex& i, const Vertex& j);
    void set_thresholds(datapath::TestParameters& tests, const datapath::Formats& formats, const EdgeMeasures& measures,
                        const datapath::HeightDecision& heights);
    std::uint64_t threshold(std::uint64_t measure, std::uint64_t usual, std::uint64_t& at_limit);
    void try_packed(const EdgeMachine& machine, const TrianglePass& pass, const Vertex& inserted);
    void try_moved(EdgeMachine& machine, const TrianglePass& here, const Vertex& inserted);
    void fault(std::uint64_t& count, const std::string& what, const EdgeMachine& machine, const TrianglePass& pass,
               const Vertex& inserted);

    Random random_;
    EdgeTrial result_;
    Vertex third_, inserted_;
};

void Trial::fault(std::uint64_t& count, const std::string& what, const EdgeMachine& machine, const TrianglePass& pass,
                  const Vertex& inserted) {
    if (++count > 1 || !result_.first_fault.empty())
        return;
    const auto& f = machine.registers.formats;
    const auto& tests = machine.registers.tests;
    result_.first_fault = fmt::format(
        "edge {} of machine {}: {}{}{}{}\n  tests {:06b}; {} test; thresholds: normal {}, height {}, view {}, "
        "highlight {}; map {} x {}; bits.fraction: position {}.{}, normal {}.{}, texture {}.{}, screen "
        "{}.{}, "
        "displacement {}, summed height {}",
        result_.edges, result_.machines, what, text_of("i", pass.triangle.vertices[0]),
        text_of("j", pass.triangle.vertices[1]), text_of("inserted", inserted), unsigned{pass.edges[0].tests},
        functions_of(f.height_test).name, tests.normal_threshold, tests.height_thresholds[0], tests.view_threshold,
        tests.highlight_normal_threshold, machine.registers.map.width, machine.registers.map.height, f.position.bits,
        f.position.fraction, f.normal.bits, f.normal.fraction, f.texture.bits, f.texture.fraction, f.screen.bits,
        f.screen.fraction, f.displacement.bits, f.summed_height.bits);
}

std::uint64_t Trial::threshold(std::uint64_t measure, std::uint64_t usual, std::uint64_t& at_limit) {
    switch (random_.bits() & 3) {
        case 0: ++at_limit; return measure;
        case 1: return measure == 0 ? 0 : measure - 1;
        default: return random_.bits() % (usual + 1);
    }
}

void Trial::set_thresholds(datapath::TestParameters& tests, const datapath::Formats& formats,
                           const EdgeMeasures& measures, const datapath::HeightDecision& heights) {
    const auto unit = static_cast<std::uint64_t>(formats.normal.highest);
    tests.normal_threshold = static_cast<std::uint32_t>(threshold(measures.normal, unit, result_.at_limit[0]));
    const datapath::HeightTestFunctions& test = functions_of(formats.height_test);
    const bool by_area = tests.summed_height_unit == datapath::SummedHeightUnit::area;
    const auto registers = test.thresholds(formats);
    std::uint64_t uncounted = 0;
    for (std::size_t k = 0; k < registers.size(); ++k) {
        const std::uint64_t value = heights.values.at(test.compared < 0 ? k : static_cast<std::size_t>(test.compared)) /
                                    (by_area ? test.weight(heights) : 1);
        const std::uint64_t most = (std::uint64_t{1} << std::max(1, registers[k].bits - 1)) - 1;
        tests.height_thresholds.at(k) = static_cast<std::int64_t>(
            threshold(value, std::min(most, 2 * value + 1), k == 0 ? result_.at_limit[1] : uncounted));
    }
    tests.view_threshold = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        threshold(measures.length, std::max<std::uint64_t>(1, measures.length * 2), result_.at_limit[2]), UINT32_MAX));
    tests.highlight_normal_threshold =
        static_cast<std::uint32_t>(random_.bits() % (measures.normal + measures.normal / 4 + 2));
    const std::uint64_t choice = random_.bits() & 3;
    result_.at_limit[3] += choice == 0 ? 1U : 0U;
    tests.highlight_cosine = choice == 0   ? measures.cosine
                             : choice == 1 ? measures.cosine - 1
                                           : random_.integer(-(std::int64_t{1} << (2 * formats.normal.fraction)),
                                                             std::int64_t{1} << (2 * formats.normal.fraction));
}

void Trial::try_edge(EdgeMachine& machine, const DirectEdge& direct, const Vertex& i, const Vertex& j) {
    TrianglePass one, other;
    one.triangle.vertices = {i, j, third_};
    other.triangle.vertices = {j, i, inserted_};
    machine.insert_vertex(one, 0);
    machine.insert_vertex(other, 0);
    inserted_ = inserted_vertex(one, 0);
    const EdgeMeasures measures = direct.measure(i, j, inserted_);
    const datapath::Formats& formats = machine.registers.formats;
    const datapath::HeightDecision heights = machine.test_heights(EdgeMachine::height_edge(i, j, inserted_.texture));
    set_thresholds(machine.registers.tests, formats, measures, heights);
    machine.decide(one, 0);
    machine.decide(other, 0);

    ++result_.edges;
    if (!same_bits(inserted_, inserted_vertex(other, 0)))
        fault(result_.unlike_reversed, "the vertex inserted on (j, i) differs", machine, one, inserted_);
    if (one.edges[0].tests != other.edges[0].tests || one.edges[0].rank != other.edges[0].rank ||
        one.split != other.split)
        fault(result_.unlike_reversed,
              fmt::format("the tests of (j, i) differ: {:06b}", unsigned{other.edges[0].tests}), machine, one,
              inserted_);
    if (const char* const what = direct.fault_of_vertex(i, j, inserted_))
        fault(result_.unlike_direct, fmt::format("{} differs from its definition", what), machine, one, inserted_);
    const datapath::HeightTestFunctions& height_test = functions_of(formats.height_test);
    for (unsigned k = 0; k < height_test.traced(formats); ++k)
        if (const auto& value = height_test.values.at(k); value.bits < 64 && heights.values.at(k) >> value.bits != 0)
            fault(result_.unlike_direct,
                  fmt::format("the height test's {} does not fit {} bits", value.name, value.bits), machine, one,
                  inserted_);
    std::uint8_t tests = direct.tests(i, j, inserted_, measures);
    if (formats.height_test != datapath::HeightTest::summed_height)
        tests = static_cast<std::uint8_t>((tests & ~datapath::summed_height_bit) |
                                          (one.edges[0].tests & datapath::summed_height_bit));
    if (tests != one.edges[0].tests)
        fault(result_.unlike_direct, fmt::format("the tests differ from their definitions: {:06b}", unsigned{tests}),
              machine, one, inserted_);

    for (std::size_t bit = 0; bit < 6; ++bit)
        result_.yes[bit] += static_cast<unsigned>(tests) >> bit & 1U;
    result_.splits += one.split & 1U;
    result_.behind += i.screen.in_front && j.screen.in_front ? 0U : 1U;
    result_.degenerate += inserted_.normal == datapath::Direction{} ? 1U : 0U;
    if ((random_.bits() & 3) == 0) {
        try_packed(machine, one, inserted_);
        try_moved(machine, one, inserted_);
    }
}

/// Every field of the vertices fits its format: a queue entry holds them.
void Trial::try_packed(const EdgeMachine& machine, const TrianglePass& pass, const Vertex& inserted) {
    const datapath::Formats& formats = machine.registers.formats;
    datapath::Triangle triangle = pass.triangle;
    triangle.vertices[2] = inserted;
    std::vector<unsigned char> entry(packed_triangle_bytes(formats) + datapath::packed_triangle_tag_bytes);
    const bool fits = pack_triangle(triangle, formats, entry.data());
    const datapath::Triangle back = datapath::unpack_triangle(entry.data(), formats);
    if (!fits || !std::equal(back.vertices.begin(), back.vertices.end(), triangle.vertices.begin(), same_bits))
        fault(result_.unlike_direct, "a vertex does not fit its queue entry", machine, pass, inserted);
}

/// Tries the same edge shifted by whole periods, from its other end: the other copy of a closed surface's seam.
void Trial::try_moved(EdgeMachine& machine, const TrianglePass& here, const Vertex& inserted) {
    const datapath::MapGeometry& map = machine.registers.map;
    const datapath::Formats& formats = machine.registers.formats;
    Vertex i = here.triangle.vertices[0], j = here.triangle.vertices[1];
    const std::uint32_t border = 1U << (formats.texture.bits - 1);
    const auto room = [&](std::uint32_t size, datapath::AddressMode mode, std::uint32_t a, std::uint32_t b) {
        const std::uint32_t period = size << formats.texture.fraction;
        return mode == datapath::AddressMode::repeat && std::max(a, b) <= border - std::min(border, period) ? period
                                                                                                            : 0U;
    };
    const std::uint32_t du = room(map.width, map.address_u, i.texture.u, j.texture.u);
    const std::uint32_t dv = room(map.height, map.address_v, i.texture.v, j.texture.v);
    if (du == 0 && dv == 0)
        return;
    ++result_.moved;
    TrianglePass there;
    for (Vertex* v : {&i, &j}) {
        v->texture.u += du;
        v->texture.v += dv;
    }
    there.triangle.vertices = {j, i, third_};
    machine.evaluate_edge(there, 0);
    Vertex back = inserted_vertex(there, 0);
    back.texture.u -= du;
    back.texture.v -= dv;
    if (!same_bits(back, inserted) || there.edges[0].tests != here.edges[0].tests ||
        there.edges[0].rank != here.edges[0].rank)
        fault(result_.unlike_moved,
              fmt::format("the edge differs when shifted by {}, {}: {:06b}", du, dv, unsigned{there.edges[0].tests}),
              machine, here, inserted);
    machine.complete(i);
    if (!(i.displaced == here.triangle.vertices[0].displaced &&
          i.displaced_normal == here.triangle.vertices[0].displaced_normal))
        fault(result_.unlike_moved, fmt::format("its end i differs when shifted by {}, {}", du, dv), machine, here,
              inserted);
}

void Trial::try_machine(RandomMachine& made, std::uint64_t edges) {
    ++result_.machines;
    EdgeMachine& machine = made.machine;
    const DirectEdge direct(machine.registers, made.map);
    third_ = inserted_ = make_random_vertex(random_, machine, nullptr);
    Vertex i = third_;
    for (std::uint64_t k = 0; k < edges; ++k) {
        const Vertex j = make_random_vertex(random_, machine, &i);
        try_edge(machine, direct, i, j);
        // Continue with inserted vertices as ends.
        third_ = i;
        i = random_.coin() ? inserted_ : j;
        if (i.generation > 14)
            i.generation = static_cast<std::uint8_t>(random_.integer(0, 3));
    }
}

EdgeTrial Trial::run(std::uint64_t edges) {
    constexpr std::array widths{FormatWidths::usual, FormatWidths::narrow, FormatWidths::wide, FormatWidths::any};
    while (result_.edges < edges) {
        RandomMachine made = make_random_machine(random_, widths[result_.machines % widths.size()]);
        try_machine(made, std::min(EdgeTrial::edges_a_machine, edges - result_.edges));
    }
    return result_;
}

}  // namespace

EdgeTrial try_random_edges(std::uint64_t seed, std::uint64_t edges) {
    return Trial(seed).run(edges);
}

}  // namespace tessera
