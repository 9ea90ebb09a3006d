#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <initializer_list>

#include "testbench/tests/support/timed_checks.h"

namespace tessera::testing {

/// A machine that has decided hand-made passes, chosen so that each counter has a different value. Functional
/// mode, no base triangles; culling and the Highlight Test are on.
///
///   passes 11, of three edges: 33 tested; by edges split 1 x 1, 2 x 2, 4 x 3: 17 split
///   split by: normal alone 3 * 3 + 1, summed height alone 2 * 2, both 1, highlight alone 2; in the highlight 3
///   stopped by: view 3, tex coord 3 + 2, generation 1 + 1; edges without a requested split are not stopped
///   one test alone: view 3, tex coord 4, generation 1; several 1
///   finished: 4 passes without a split, 5 second passes for normals: 9, of which 2 are culled
///   vertices calculated 33, discarded 33 - 17; normals 3 * 5; children 2 + 2 * 3 + 4 * 4 = 24, all waiting
class HandMadeRun {
  public:
    MachineSetup setup;
    Simulation simulation{setup, 1000};

    explicit HandMadeRun(datapath::Triangulation triangulation = datapath::Triangulation::shorter)
        : setup(make(triangulation)) {
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
        const unsigned n = datapath::normal_bit, s = datapath::summed_height_bit, h = datapath::highlight_bit;
        const unsigned view = datapath::view_bit, tex_coord = datapath::tex_coord_bit,
                       generation = datapath::generation_bit, all = datapath::gating_tests;
        for (int k = 0; k < 3; ++k)
            decide({n | all, n | all, n | all});
        for (int k = 0; k < 2; ++k)
            decide({s | all, s | all, all});
        decide({n | s | all, all, all});
        decide({h | all, h | all, n | h | all});
        decide({n | tex_coord | generation, s | tex_coord | generation, n | s | tex_coord | generation});
        decide({n | view | generation, n | view | generation, n | view});
        decide({n | view | generation, h | view | generation, 0});
        decide({s | view | tex_coord, view, 0});
        for (int k = 0; k < 5; ++k)
            fetch_normals(k < 2);
    }

  private:
    static MachineSetup make(datapath::Triangulation triangulation) {
        Job job;
        job.mode = Mode::functional;
        job.map.width = job.map.height = 8;
        job.tests.highlight = true;
        job.hardware.culling = Culling::back;
        MachineSetup setup = setup_of(job);
        setup.base_triangles.clear();
        setup.registers.triangulation = triangulation;
        return setup;
    }
    /// A triangle with all values known, its normals in screen space only if `with_normals`.
    static TakenTriangle known_triangle(bool with_normals) {
        TakenTriangle taken;
        for (datapath::Vertex& vertex : taken.triangle.vertices) {
            vertex.displaced_known = true;
            vertex.screen_normal_known = with_normals;
        }
        return taken;
    }
    void bring_parts(TakenTriangle taken) {
        sc_core::sc_time delay;
        simulation.machine.get_triangle.to_join.transport(taken, delay);
        for (std::uint8_t part = 0; part < 9; ++part) {
            DisplacedPoint point;
            point.tag.part = part;
            if ((parts_of(taken.triangle) & point.tag.bit()) != 0)
                simulation.machine.displace_vertex.to_transform.transport(point, delay);
        }
    }
    void decide(std::initializer_list<unsigned> tests) {
        bring_parts(known_triangle(true));
        std::uint8_t part = first_edge_part;
        for (const unsigned bits : tests) {
            TestedEdge edge;
            edge.tag.part = part++;
            edge.found.tests = static_cast<std::uint8_t>(bits);
            edge.found.evaluated = datapath::all_tests;
            sc_core::sc_time delay;
            simulation.machine.tessellation_tests[0].collector.tested_edges().transport(edge, delay);
        }
    }
    void fetch_normals(bool turned_away) {
        TakenTriangle taken = known_triangle(false);
        taken.triangle.finished = true;
        taken.triangle.vertices[0].screen = {0, 0, 1, true};
        taken.triangle.vertices[turned_away ? 2 : 1].screen = {1, 0, 1, true};
        taken.triangle.vertices[turned_away ? 1 : 2].screen = {0, 1, 1, true};
        bring_parts(taken);
    }
};

}  // namespace tessera::testing
