#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/rank.h"
#include "modules/datapath/transform.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/units/edge_tests/declared_reads.h"

namespace tessera {

/// What the units do with vertices and edges: calls of the datapath's functions, without SystemC. A Scene derives from
/// it and has
///   const datapath::Registers& scene_registers() const        may change between calls
///   std::uint64_t code_entry(std::uint64_t index) const       of the displacement map
///   std::uint64_t normal_entry(std::uint64_t index) const     of the normal map
///   std::uint64_t height_entry(std::uint64_t offset) const    of the height test's table, in bytes from its base
template <class Scene>
class BareEdges {
  public:
    /// Calculates a base vertex's values of its first pass.
    void complete(datapath::Vertex& v) {
        v.displaced = displaced(v.position, v.normal, v.texture);
        v.screen = transform(v.displaced, r().transform, formats(), saturations);
        v.displaced_normal = bumped(v.normal, v.tangent, v.handedness, v.texture);
        v.displaced_known = true;
    }

    void complete_base(datapath::Triangle& triangle) {
        for (datapath::Vertex& v : triangle.vertices)
            complete(v);
    }

    datapath::Position displaced(const datapath::Position& p, const datapath::Direction& n,
                                 const datapath::TexCoord& t) {
        const auto entries =
            entries_at(t, r().displacement_map, [&](std::uint64_t index) { return scene().code_entry(index); });
        return displace(p, n, map_code(t, entries.data(), formats()), r().displacement, formats(), saturations);
    }

    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& tangent, int handedness,
                               const datapath::TexCoord& t) {
        const auto entries =
            entries_at(t, r().normal_map, [&](std::uint64_t index) { return scene().normal_entry(index); });
        return bump(n, tangent, handedness, datapath::map_normal(t, entries.data(), formats()), formats(), saturations);
    }

    /// Calculates what the tests need of edge k's midpoint: t, N, T and N'.
    void find_midpoint(datapath::TrianglePass& pass, int k) {
        const datapath::Vertex &i = pass.edge_begin(k), &j = pass.edge_end(k);
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        edge.texture = midpoint(i.texture, j.texture);
        edge.normal = normalise(midpoint(i.normal, j.normal), formats(), saturations);
        edge.tangent = normalise(midpoint(i.tangent, j.tangent), formats(), saturations);
        edge.displaced_normal =
            bumped(edge.normal, edge.tangent, datapath::inserted_handedness(i.handedness, j.handedness), edge.texture);
    }

    /// Calculates the vertex to be inserted on edge k.
    void insert_vertex(datapath::TrianglePass& pass, int k) {
        find_midpoint(pass, k);
        const datapath::Vertex &i = pass.edge_begin(k), &j = pass.edge_end(k);
        const datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
        made.position = midpoint(i.position, j.position);
        made.texture = edge.texture;  // both branches calculate it
        made.mean_normal = midpoint(i.normal, j.normal);
        made.displaced = displaced(made.position, edge.normal, made.texture);
        made.screen = transform(made.displaced, r().transform, formats(), saturations);
    }

    /// Evaluates every test of edge k, whose midpoint is known, and sets its bit of pass.split if they ask for a split.
    void decide(datapath::TrianglePass& pass, int k) const {
        const datapath::Vertex &i = pass.edge_begin(k), &j = pass.edge_end(k);
        const datapath::TestParameters& on = r().tests;
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        unsigned tests = 0;
        if (on.normal_test && normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, on))
            tests |= datapath::normal_bit;
        edge.rank = 0;
        if (on.summed_height_test) {
            const datapath::HeightDecision decision = test_heights(height_edge(i, j, edge.texture));
            edge.rank = decision.rank;
            if (decision.asks)
                tests |= datapath::summed_height_bit;
        }
        if (!on.view_test || view_test(i.screen, j.screen, on))
            tests |= datapath::view_bit;
        if (!on.tex_coord_test || tex_coord_test(i.texture, j.texture, edge.texture, formats()))
            tests |= datapath::tex_coord_bit;
        if (!on.generation_test || generation_test(i.generation, j.generation, on))
            tests |= datapath::generation_bit;
        edge.tests = static_cast<std::uint8_t>(tests);
        if (on.highlight_test)
            test_for_highlight(i, j, edge, on);
        edge.evaluated = datapath::all_tests;
        if (datapath::split_decision(edge.tests))
            pass.split = static_cast<std::uint8_t>(pass.split | 1u << k);
    }

    void evaluate_edge(datapath::TrianglePass& pass, int k) {
        insert_vertex(pass, k);
        decide(pass, k);
    }

    /// Evaluates all edges.
    void evaluate(datapath::TrianglePass& pass) {
        pass.split = 0;
        for (int k = 0; k < 3; ++k)
            evaluate_edge(pass, k);
        conclude(pass);
    }

    /// Once all edges are decided: the edges to split, and the tests that kept edges whole (Triangle::stopped_by).
    void conclude(datapath::TrianglePass& pass) const {
        unsigned stopped_by = 0;
        for (const datapath::EdgeTests& edge : pass.edges)
            if ((edge.tests & datapath::requesting_tests) != 0)
                stopped_by |= ~edge.tests & datapath::gating_tests;
        pass.triangle.stopped_by = static_cast<std::uint8_t>(pass.split == 0 ? stopped_by : 0);
        pass.split = static_cast<std::uint8_t>(edges_to_split(pass.split, r().triangulation, pass));
    }

    /// An edge as the height test sees it, with the codes of its ends unknown.
    static datapath::HeightEdge height_edge(const datapath::Vertex& i, const datapath::Vertex& j,
                                            const datapath::TexCoord& ij) {
        return {i.texture, j.texture, ij, false, 0, 0, edge_in_view(i.screen, j.screen)};
    }

    /// What the design's height test makes of an edge, on or off. Throws std::logic_error if its reads are not as declared,
    /// or lie outside the table.
    datapath::HeightDecision test_heights(const datapath::HeightEdge& edge) const {
        const datapath::Registers& registers = r();
        datapath::Reads reads;
        height_test_.reads(edge, registers, reads);
        if (!as_declared(height_test_, reads, registers))
            throw std::logic_error(fault_of(height_test_, reads, registers));
        datapath::Entries entries;  // NOLINT(cppcoreguidelines-pro-type-member-init): as many as are read
        const bool codes = reads.last_port() == 1;
        const datapath::TableLayout& table = codes ? registers.displacement_map : registers.height_table;
        const std::uint64_t bytes = table.bytes();
        for (unsigned k = 0; k < reads.entries(); ++k) {
            const std::uint64_t offset = reads.addresses()[k] - table.base;
            if (offset >= bytes)
                read_outside(offset, bytes);
            entries[k] = codes ? scene().code_entry(offset / table.entry_bytes) : scene().height_entry(offset);
        }
        datapath::HeightDecision decision;
        height_test_.decide(edge, entries, registers, decision);
        return decision;
    }

    /// Counts so far. The machine normalises N_ij in two units and counts each; Lighting is not part of this.
    datapath::Saturations saturations;

  protected:
    /// height_test: the scene's, which must not change.
    explicit BareEdges(datapath::HeightTest height_test) : height_test_(functions_of(height_test)) {}

  private:
    [[noreturn, gnu::noinline]] void read_outside(std::uint64_t offset, std::uint64_t bytes) const {
        throw std::out_of_range("height test " + std::string(height_test_.name) + ": reads() adds byte " +
                                std::to_string(static_cast<std::int64_t>(offset)) + " of a table of " +
                                std::to_string(bytes) + " bytes");
    }
    const Scene& scene() const { return static_cast<const Scene&>(*this); }
    const datapath::Registers& r() const { return scene().scene_registers(); }
    const datapath::Formats& formats() const { return r().formats; }

    /// The map's entries that are read at t (datapath::map_entries).
    template <class Read>
    std::array<std::uint64_t, 4> entries_at(const datapath::TexCoord& t, const datapath::TableLayout& layout,
                                            Read&& read) const {
        // A layout of one "byte" per entry turns the datapath's addresses into indices.
        const datapath::TableLayout as_indices{0, layout.columns, layout.rows, 1};
        std::array<std::uint64_t, 4> entries{};
        std::size_t count = 0;
        map_entries(t, as_indices, r().map, formats(), [&](std::uint64_t index) { entries[count++] = read(index); });
        return entries;
    }

    /// Not inlined, as in the unit (modules/units/edge_tests/normal.h): a design without the test spends no register
    /// on it.
    [[gnu::noinline]] static void test_for_highlight(const datapath::Vertex& i, const datapath::Vertex& j,
                                                     datapath::EdgeTests& edge, const datapath::TestParameters& tests) {
        if (highlight_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, tests))
            edge.tests |= datapath::highlight_bit;
    }

    const datapath::HeightTestFunctions& height_test_;
};

}  // namespace tessera
