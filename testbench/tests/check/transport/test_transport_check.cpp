#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/check/transport/conservation.h"
#include "testbench/tests/support/timed_checks.h"

// The transport check (key check.work) over whole runs: nothing is lost, duplicated or altered on the way to the
// rasteriser.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

void require_work_conserved(const Job& job) {
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 1'000'000);
    TransportCheck work(setup.registers, setup.base_triangles);
    observe(simulation, work);
    REQUIRE(simulation.run().empty());
    const WorkResult result = work_result(work, simulation);
    INFO(result.first_violation);
    CHECK(result.passed());
    CHECK(result.triangles == simulation.machine.pass_or_tessellate.counts().passes);
    CHECK(result.equations > 10);

    // The same, with one triangle more at the rasteriser.
    work.write(LitTriangle{});
    const WorkResult doubled = work_result(work, simulation);
    CHECK(doubled.violations == 1);
    CHECK_THAT(doubled.first_violation, Contains("1 more triangles were lit than expected"));
}

/// One base triangle, decided and not split, finished and lit. It faces the viewer; N and N' are zero, so that only
/// ambient light remains.
struct OneTriangle {
    datapath::Registers registers;
    datapath::Triangle base;
    datapath::TrianglePass pass;
    datapath::Triangle finished;
    LitTriangle lit;

    OneTriangle() {
        registers.light.ambient = 50;
        registers.back_face_culling = true;
        base.base = 0;
        pass.triangle = base;
        pass.new_vertices = 7;
        const datapath::ScreenPosition corners[] = {{0, 0, 1, true}, {4, 0, 1, true}, {0, 4, 1, true}};
        for (std::size_t k = 0; k < 3; ++k)
            pass.triangle.vertices[k].screen = lit.corners[k].screen = corners[k];
        finished = pass.triangle;
        for (LitTriangle::Corner& corner : lit.corners)
            corner.intensity = 50;
    }
    WorkResult result() const {
        TransportCheck check(registers, {base});
        check.write(pass);
        check.write(finished);
        check.write(lit);
        return check.result();
    }
};

}  // namespace

TEST_CASE("work check: a changed field of a triangle is detected where it changes") {
    const WorkResult right = OneTriangle{}.result();
    INFO(right.first_violation);
    REQUIRE(right.passed());
    CHECK(right.triangles == 1);

    using datapath::Vertex;
    struct Field {
        const char* name;
        std::function<void(Vertex&)> change;
        bool of_base;  // set by the host; the others are computed when the triangle is decided
    };
    const std::vector<Field> fields = {
        {"position.x", [](Vertex& v) { ++v.position.x; }, true},
        {"position.y", [](Vertex& v) { ++v.position.y; }, true},
        {"position.z", [](Vertex& v) { ++v.position.z; }, true},
        {"normal.x", [](Vertex& v) { ++v.normal.x; }, true},
        {"normal.y", [](Vertex& v) { ++v.normal.y; }, true},
        {"normal.z", [](Vertex& v) { ++v.normal.z; }, true},
        {"tangent.x", [](Vertex& v) { ++v.tangent.x; }, true},
        {"tangent.y", [](Vertex& v) { ++v.tangent.y; }, true},
        {"tangent.z", [](Vertex& v) { ++v.tangent.z; }, true},
        {"texture.u", [](Vertex& v) { ++v.texture.u; }, true},
        {"texture.v", [](Vertex& v) { ++v.texture.v; }, true},
        {"handedness", [](Vertex& v) { v.handedness = static_cast<std::int8_t>(-v.handedness); }, true},
        {"generation", [](Vertex& v) { ++v.generation; }, true},
        {"displaced.x", [](Vertex& v) { ++v.displaced.x; }, false},
        {"displaced.y", [](Vertex& v) { ++v.displaced.y; }, false},
        {"displaced.z", [](Vertex& v) { ++v.displaced.z; }, false},
        {"displaced_normal.x", [](Vertex& v) { ++v.displaced_normal.x; }, false},
        {"displaced_normal.y", [](Vertex& v) { ++v.displaced_normal.y; }, false},
        {"displaced_normal.z", [](Vertex& v) { ++v.displaced_normal.z; }, false},
        {"screen.x", [](Vertex& v) { ++v.screen.x; }, false},
        {"screen.y", [](Vertex& v) { ++v.screen.y; }, false},
        {"screen.w", [](Vertex& v) { ++v.screen.w; }, false},
        {"screen.in_front", [](Vertex& v) { v.screen.in_front = !v.screen.in_front; }, false}};
    const std::string other = " as expected, but not the same ones";
    for (const Field& field : fields)
        for (std::size_t k = 0; k < 3; ++k) {
            INFO(field.name << " of vertex " << k);
            OneTriangle work;
            field.change(work.finished.vertices[k]);
            CHECK(work.result().first_violation == "base triangle 0: as many triangles were finished" + other);
            work = OneTriangle{};
            field.change(work.base.vertices[k]);
            CHECK(work.result().passed() != field.of_base);
        }

    const auto found = [](const std::function<void(OneTriangle&)>& change) {
        OneTriangle work;
        change(work);
        return work.result().first_violation;
    };
    CHECK(found([](OneTriangle& w) { ++w.finished.split_by; }) ==
          "base triangle 0: as many triangles were finished" + other);
    CHECK(found([](OneTriangle& w) { ++w.finished.stopped_by; }) ==
          "base triangle 0: as many triangles were finished" + other);
    CHECK(found([](OneTriangle& w) { ++w.base.split_by; }) ==
          "base triangle 0: as many triangles were decided" + other);
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(found([k](OneTriangle& w) { ++w.finished.vertices[k].screen_normal.y; }) ==
              "base triangle 0: a finished triangle's vertex " + std::to_string(k) +
                  " has N's (0, 1, 0); its N' transforms to (0, 0, 0)");
        for (const auto& change : std::vector<std::function<void(LitTriangle::Corner&)>>{
                 [](auto& c) { ++c.intensity; }, [](auto& c) { ++c.texture.u; }, [](auto& c) { ++c.texture.v; },
                 [](auto& c) { ++c.screen.x; }, [](auto& c) { ++c.screen.y; }, [](auto& c) { ++c.screen.w; },
                 [](auto& c) { c.screen.in_front = false; }})
            CHECK(found([&](OneTriangle& w) { change(w.lit.corners[k]); }) ==
                  "all base triangles: as many triangles were lit" + other);
    }
    CHECK(found([](OneTriangle& w) { w.pass.triangle.base = w.finished.base = 1; }) ==
          "base triangle 0: 1 triangles expected to be decided were not");
    // A triangle without a base triangle, a lost one, and a lit one that faces away.
    OneTriangle stray;
    TransportCheck check(stray.registers, {});
    check.write(stray.pass);
    CHECK(check.result().first_violation == "no base triangle: 1 more triangles were decided than expected");
    check.write(stray.finished);
    CHECK(check.result().violations == 2);  // decided, and not yet lit
    CHECK(found([](OneTriangle& w) { w.pass.split = 7; }) ==
          "base triangle 0: 4 triangles expected to be decided were not");
    CHECK(found([](OneTriangle& w) {
              for (const auto turn : {&w.pass.triangle, &w.finished})
                  std::swap(turn->vertices[1].screen, turn->vertices[2].screen);
              std::swap(w.lit.corners[1].screen, w.lit.corners[2].screen);
          }) == "all base triangles: 1 more triangles were lit than expected");
}

TEST_CASE("work is conserved: half donut, functional, culled") {
    Job job;
    job.mode = Mode::functional;
    job.hardware.culling = Culling::back;
    require_work_conserved(job);
}

TEST_CASE("work is conserved: half donut, timed, a queue that spills, three tests units") {
    Job job = timed_job();
    job.hardware.queue.capacity = 16;
    job.hardware.tests_units = 3;
    require_work_conserved(job);
}
