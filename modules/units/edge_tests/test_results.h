#pragma once
#include "modules/datapath/edge_tests.h"
#include "modules/sockets/items.h"
#include "modules/stage/signals.h"

namespace tessera {

// Adds test results to an edge, for the unit that collects them.

/// Records a test's decision, and that it was evaluated.
constexpr void set_test(datapath::EdgeTests& edge, bool decided, datapath::TestBits bit) {
    edge.evaluated = static_cast<std::uint8_t>(edge.evaluated | bit);
    if (decided)
        edge.tests = static_cast<std::uint8_t>(edge.tests | bit);
}

constexpr void add_result(TestedEdge& edge, const NormalResult& result) {
    edge.found.normal = result.n;
    edge.found.tangent = result.tangent;
    edge.found.displaced_normal = result.displaced_n;
    edge.displaced_n_i = result.displaced_n_i;
    set_test(edge.found, result.normal, datapath::normal_bit);
    set_test(edge.found, result.highlight, datapath::highlight_bit);
}
constexpr void add_result(TestedEdge& edge, const TexCoordResult& result) {
    edge.found.texture = result.t_ij;
    set_test(edge.found, result.tex_coord, datapath::tex_coord_bit);
    set_test(edge.found, result.generation, datapath::generation_bit);
}
constexpr void add_result(TestedEdge& edge, const HeightResult& result) {
    edge.found.rank = result.rank;
    set_test(edge.found, result.summed_height, datapath::summed_height_bit);
}
constexpr void add_result(TestedEdge& edge, const ViewResult& result) {
    set_test(edge.found, result.view, datapath::view_bit);
}

/// Shows an edge as it leaves: its fields, each test, the decision.
inline void show_tested_edge(Signals& signals, const TestedEdge& edge, const datapath::TestParameters& parameters) {
    const unsigned tests = edge.found.tests;
    signals.item("out", edge);
    signals.flag("normal", (tests & datapath::normal_bit) != 0);
    signals.flag("summed_height", (tests & datapath::summed_height_bit) != 0);
    signals.flag("view", (tests & datapath::view_bit) != 0);
    signals.flag("tex_coord", (tests & datapath::tex_coord_bit) != 0);
    signals.flag("generation", (tests & datapath::generation_bit) != 0);
    if (parameters.highlight_test)
        signals.flag("highlight", (tests & datapath::highlight_bit) != 0);
    signals.flag("split", datapath::split_decision(static_cast<std::uint8_t>(tests)));
}

}  // namespace tessera
