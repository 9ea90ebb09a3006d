#include <catch2/catch.hpp>
#include <cstdint>

#include "modules/datapath/cull.h"
#include "modules/datapath/light.h"
#include "testbench/common/hash.h"
#include "testbench/common/random.h"
#include "testbench/prove/random_edges/datapath_edge.h"
#include "testbench/prove/random_edges/datapath_random_tables.h"

/// Integer arithmetic only, so every compiler must give the same bits at every optimisation level.
using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

class Hash {
  public:
    void add(std::int64_t value) {
        for (int k = 0; k < 8; ++k)
            state_ = tessera::fnv1a(state_, static_cast<std::uint64_t>(value) >> (8 * k) & 255);
    }
    void add(const Direction& d) {
        add(d.x);
        add(d.y);
        add(d.z);
    }
    void add(const Position& p) {
        add(p.x);
        add(p.y);
        add(p.z);
    }
    void add(const ScreenPosition& s) {
        add(s.x);
        add(s.y);
        add(s.w);
        add(s.in_front ? 1 : 0);
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = tessera::fnv1a_basis;
};

}  // namespace

TEST_CASE("fingerprint: a hundred thousand random triangles give the recorded bits") {
    Random random(33);
    Registers registers;
    registers.map = {97, 61, AddressMode::repeat, AddressMode::clamp};
    const Tables tables = random_tables(random, registers);
    registers.tests.normal_threshold = 9000;
    registers.tests.height_thresholds[0] = 90000;
    registers.tests.view_threshold = 30 << 8;
    registers.displacement = {1 << 15, -9000};
    registers.transform.row_x = {14000000, 300000, -2000000, std::int64_t{1} << 41};
    registers.transform.row_y = {-500000, 15000000, 1000000, -(std::int64_t{1} << 40)};
    registers.transform.row_w = {1000000, -2000000, -16000000, std::int64_t{1} << 41};
    registers.transform.exponent = 8;
    registers.transform.near_plane = std::int64_t{1} << 36;
    for (auto& row : registers.transform.normal_rows)
        row = {random.integer32(-9000, 9000), random.integer32(-9000, 9000), random.integer32(-9000, 9000)};
    registers.light = {{3000, 5000, 15000}, 51};
    EdgeMachine machine(registers, tables);

    Hash hash;
    for (int k = 0; k < 100'000; ++k) {
        Triangle triangle;
        for (Vertex& v : triangle.vertices) {
            const auto position = [&] { return random.integer32(-200000, 200000); };
            v.position = {position(), position(), position()};
            v.normal = random_normal(random, registers.formats);
            v.tangent = random_normal(random, registers.formats);
            v.texture = {random.natural(0, 2 * 97 << 12), random.natural(0, 61 << 12)};
            v.handedness = random.coin() ? std::int8_t{1} : std::int8_t{-1};
            v.generation = static_cast<std::uint8_t>(random.integer(0, 12));
            machine.complete(v);
            v.screen_normal =
                transform_normal(v.displaced_normal, registers.transform, registers.formats, machine.saturations);
            hash.add(v.screen_normal);
            hash.add(light(v.screen_normal, registers.light, registers.formats, machine.saturations));
        }
        const auto& v = triangle.vertices;
        hash.add(faces_away(v[0].screen, v[1].screen, v[2].screen) ? 1 : 0);
        const TrianglePass pass = machine.evaluate(triangle);
        for (std::size_t e = 0; e < 3; ++e)
            hash.add(pass.edges[e].tests);
        tessellate(pass, Triangulation::shorter, registers.formats, machine.saturations, [&](const Triangle& child) {
            for (const Vertex& c : child.vertices) {
                hash.add(c.position);
                hash.add(c.normal);
                hash.add(c.tangent);
                hash.add(c.texture.u);
                hash.add(c.texture.v);
                hash.add(c.handedness);
                hash.add(c.generation);
                hash.add(c.displaced);
                hash.add(c.displaced_normal);
                hash.add(c.screen);
            }
        });
    }
    const Saturations& s = machine.saturations;
    for (const std::uint64_t count :
         {s.displaced_position, s.normal, s.screen_position, s.screen_normal, s.degenerate_normal})
        hash.add(static_cast<std::int64_t>(count));
    // A change here changes the machine's results: it must be intended.
    CHECK(hash.value() == 0x0dabae49d3460c44U);
}
