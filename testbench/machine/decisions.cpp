#include "testbench/machine/decisions.h"

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/midpoint.h"

namespace tessera {

using datapath::TestBits;

Decisions::Decisions(const MachineSetup& setup)
    : registers_(setup.registers),
      height_test_(functions_of(registers_.formats.height_test)),
      reads_vary_(height_test_.may_read_nothing || height_test_.reads_codes(registers_.formats)) {
    if (setup.design.test_order != TestOrder::parallel || setup.registers.formats.final_edges ||
        setup.registers.formats.families)
        bare_.emplace(setup);
}

void Decisions::count(std::uint8_t tests) {
    const unsigned requested = tests & datapath::requesting_tests;
    if (datapath::split_decision(tests)) {
        const unsigned by = requested & (datapath::normal_bit | datapath::summed_height_bit);
        counts_.split_by_normal += by == datapath::normal_bit;
        counts_.split_by_summed_height += by == datapath::summed_height_bit;
        counts_.split_by_both += by == (datapath::normal_bit | datapath::summed_height_bit);
        counts_.split_by_highlight += by == 0;
        counts_.split_in_highlight += (requested & datapath::highlight_bit) != 0;
    } else if (requested != 0) {
        const unsigned missing = ~tests & datapath::gating_tests;
        counts_.stopped_by_view += (missing & datapath::view_bit) != 0;
        counts_.stopped_by_tex_coord += (missing & datapath::tex_coord_bit) != 0;
        counts_.stopped_by_generation += (missing & datapath::generation_bit) != 0;
        counts_.stopped_by_view_alone += missing == datapath::view_bit;
        counts_.stopped_by_tex_coord_alone += missing == datapath::tex_coord_bit;
        counts_.stopped_by_generation_alone += missing == datapath::generation_bit;
        counts_.stopped_by_several += (missing & (missing - 1)) != 0;
    }
}

/// An edge that requests a split while another is cut is counted when it is tested again.
void Decisions::count(const datapath::TrianglePass& pass) {
    for (unsigned k = 0; k < 3; ++k) {
        const std::uint8_t tests = pass.edges[k].tests;
        if (!datapath::split_decision(tests) || (pass.split >> k & 1u) != 0)
            count(tests);
    }
}

/// The reads of an edge, in a design whose edges read more than its height test's table, or nothing.
void Decisions::count_reads(const datapath::TrianglePass& pass, int k) {
    const datapath::Vertex& i = pass.edge_begin(k);
    const datapath::Vertex& j = pass.edge_end(k);
    const bool displaced_before = pass.new_vertices == 0 || registers_.formats.families;
    datapath::Reads reads;
    height_test_.reads({i.texture, j.texture, midpoint(i.texture, j.texture), displaced_before}, registers_, reads);
    evaluated_.off_lattice += reads.requests() == 0;
    evaluated_.summed_height_by_codes += reads.last_port() == 1 && registers_.tests.summed_height_test;
}

void Decisions::write(const datapath::TrianglePass& pass) {
    for (int k = 0; k < 3; ++k) {
        if ((pass.shared >> k & 1) != 0)
            continue;
        const unsigned evaluated = pass.edges[static_cast<std::size_t>(k)].evaluated;
        evaluated_.normal += (evaluated & datapath::normal_bit) != 0;
        if ((evaluated & datapath::summed_height_bit) == 0)
            continue;
        ++evaluated_.summed_height;
        if (reads_vary_)
            count_reads(pass, k);
    }
    if (!bare_) {
        count(pass);
        return;
    }
    datapath::TrianglePass all = pass;
    evaluate(all);
    count(all);
    stopped_by(pass.triangle) = all.triangle.stopped_by;
    unsigned split_by = 0;
    for (unsigned k = 0; k < 3; ++k) {
        const std::uint8_t tests = all.edges[k].tests;
        if ((pass.split >> k & 1u) != 0)
            split_by |= tests & datapath::requesting_tests;
    }
    if (split_by == 0)
        return;
    if (pass.number >= split_by_.size())
        split_by_.resize(std::size_t{pass.number} + 1);
    split_by_[pass.number] = static_cast<std::uint8_t>(split_by);
}

/// Evaluates the tests that the machine has not evaluated.
void Decisions::evaluate(datapath::TrianglePass& pass) {
    pass.split = 0;
    for (int k = 0; k < 3; ++k) {
        const datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        if ((edge.evaluated & datapath::normal_bit) == 0)
            bare_->find_midpoint(pass, k);
        if (edge.evaluated != datapath::all_tests)
            bare_->decide(pass, k);
        else if (datapath::split_decision(edge.tests))
            pass.split = static_cast<std::uint8_t>(pass.split | 1u << k);
    }
    bare_->conclude(pass);
}

/// A triangle without split edges is finished as soon as it is decided, a base triangle perhaps a pass later.
std::uint8_t& Decisions::stopped_by(const datapath::Triangle& triangle) {
    const bool is_base = triangle.split_by == 0;
    const std::size_t place = is_base ? std::size_t{triangle.base} + 1 : 0;
    if (place >= stopped_by_.size())
        stopped_by_.resize(place + 1);
    return stopped_by_[place];
}

void Decisions::complete_tags(const datapath::Triangle& finished, EmittedTriangle& emitted) {
    if (!bare_)
        return;
    if (finished.split_by != 0 && finished.parent < split_by_.size())
        emitted.split_by = split_by_[finished.parent];
    emitted.stopped_by = stopped_by(finished);
}

}  // namespace tessera
