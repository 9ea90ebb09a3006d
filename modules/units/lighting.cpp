#include "modules/units/lighting.h"

#include "modules/datapath/light.h"
#include "modules/unit/signals.h"

namespace tessera {

Lighting::Lighting(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing)
    : Unit(name, clock), registers_(registers), timing_(timing.lighting), pipeline_(timing.lighting) {
    from_pass_or_tessellate.serve<&Lighting::b_transport>(*this);
    from_pass_or_tessellate.clocked_by(clock, *this, timing_.buffer, timing.stalls);
    to_rasteriser.clocked_by(clock, *this);
}

LitTriangle Lighting::light(const datapath::Triangle& triangle) {
    LitTriangle lit;
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = triangle.vertices[k];
        if (!vertex.screen_normal_known)
            SC_REPORT_ERROR("tessera/lighting", "a triangle came without its normals in screen space");
        lit.corners[k] = {
            vertex.screen, vertex.texture,
            datapath::light(vertex.screen_normal, registers_.light, registers_.formats, saturations_)};
    }
    return lit;
}

void Lighting::b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    LitTriangle lit = light(triangle);
    delay += clock_.period() * timing_.latency;
    to_rasteriser->b_transport(lit, delay);
}

void Lighting::step() {
    const std::uint64_t cycle = now();
    from_pass_or_tessellate.admit();
    while (pipeline_.front_finished(cycle)) {
        if (offered_ ? !to_rasteriser.free() : !to_rasteriser.send(pipeline_.front())) {
            offered_ = true;
            break;
        }
        offered_ = false;
        pipeline_.pop();
        activity_.item_out(cycle);
        clock_.progress();
    }
    while (!from_pass_or_tessellate.empty() && pipeline_.may_start(cycle)) {
        pipeline_.start(cycle) = light(from_pass_or_tessellate.front());
        activity_.item_in(cycle);
        from_pass_or_tessellate.pop();
    }
    if (offered_)
        activity_.set(cycle, State::blocked, to_rasteriser.consumer());
    else
        activity_.set(cycle,
                      pipeline_.empty() && from_pass_or_tessellate.empty() ? State::starved : State::busy);
    wake_at(pipeline_.next_finished(cycle));
    if (!from_pass_or_tessellate.empty())
        wake_at(pipeline_.next_start(cycle));
}

std::string Lighting::holds() const {
    return count_of(pipeline_.size() + from_pass_or_tessellate.size(), "triangle");
}

void Lighting::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(from_pass_or_tessellate);
    signals.group(signals.changed(activity_.items_in()), [&] {
        const LitTriangle& lit = pipeline_.newest();
        signals.screen("screen_0_x", "screen_0_y", lit.corners[0].screen);
        signals.screen("screen_1_x", "screen_1_y", lit.corners[1].screen);
        signals.screen("screen_2_x", "screen_2_y", lit.corners[2].screen);
        signals.value("intensity_0", 8, lit.corners[0].intensity);
        signals.value("intensity_1", 8, lit.corners[1].intensity);
        signals.value("intensity_2", 8, lit.corners[2].intensity);
    });
}

}  // namespace tessera
