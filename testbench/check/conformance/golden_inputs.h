#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "golden/golden_model.h"
#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Converts the hardware's integers to the golden model's doubles. Exact: every format fits a double.
class Dequantise {
  public:
    explicit Dequantise(const datapath::Formats& formats)
        : position_lsb_(std::ldexp(1.0, -formats.position.fraction)),
          normal_lsb_(std::ldexp(1.0, -formats.normal.fraction)),
          texture_lsb_(std::ldexp(1.0, -formats.texture.fraction)),
          screen_lsb_(std::ldexp(1.0, -formats.screen.fraction)),
          view_distance_lsb_(std::ldexp(1.0, -formats.view_distance.fraction)) {}

    glm::dvec3 position(const datapath::Position& p) const { return glm::dvec3(p.x, p.y, p.z) * position_lsb_; }
    glm::dvec3 direction(const datapath::Direction& d) const { return glm::dvec3(d.x, d.y, d.z) * normal_lsb_; }
    glm::dvec2 texture(const datapath::TexCoord& t) const { return glm::dvec2(t.u, t.v) * texture_lsb_; }

    /// All fields except N's, which the golden model lacks. P', N' and P's are valid only if the hardware has
    /// calculated them.
    golden::Vertex vertex(const datapath::Vertex& v) const {
        golden::Vertex g;
        g.position = position(v.position);
        g.normal = direction(v.normal);
        g.tangent = direction(v.tangent);
        g.handedness = v.handedness;
        g.texture = texture(v.texture);
        g.displaced_position = position(v.displaced);
        g.displaced_normal = direction(v.displaced_normal);
        g.screen = glm::dvec2(v.screen.x, v.screen.y) * screen_lsb_;
        g.w = v.screen.w * view_distance_lsb_;
        g.distance = v.screen.distance * view_distance_lsb_;
        g.in_front = v.screen.in_front;
        g.generation = v.generation;
        return g;
    }

  private:
    double position_lsb_, normal_lsb_, texture_lsb_, screen_lsb_, view_distance_lsb_;
};

golden::AddressMode golden_mode(datapath::AddressMode mode);
golden::Diagonal golden_diagonal(datapath::Triangulation choice);
golden::Filter golden_filter(datapath::MapFilter filter);

/// Fitted heights, which golden takes as given.
void set_heights(golden::Map& map, const std::vector<std::uint16_t>& fitted);

/// The registers, but for the height test's, as the golden model's parameters. Exact except for the transform's fourth column and the near plane,
/// 64 bit integers that a double rounds to 53 bits.
golden::Parameters golden_parameters(const datapath::Registers& registers);

/// The scoreboard's inputs to golden: the hardware's map and registers, dequantised, so that both sides can differ in
/// arithmetic only. setup_check.h compares each entry with golden's own. Memory: 36 bytes per texel.
struct GoldenInputs {
    golden::Map map;
    golden::Parameters parameters;

    explicit GoldenInputs(const MachineSetup& setup);
};

/// The quantised base triangles, dequantised: the first five members of each vertex.
std::vector<std::array<golden::Vertex, 3>> golden_base_triangles(const MachineSetup& setup);

}  // namespace tessera
