#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "testbench/check/mesh/invariants.h"
#include "testbench/common/hash.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/prove/random_machines/random_case.h"
#include "testbench/tests/support/program_runner.h"

/// Tests the generator of random cases and its program; tessera_random_cases itself tests that the cases pass.
using namespace tessera;
using Catch::Contains;

namespace {

bool same(const datapath::Vertex& a, const datapath::Vertex& b) {
    return a.position == b.position && a.normal == b.normal && a.tangent == b.tangent && a.texture == b.texture &&
           a.handedness == b.handedness;
}

ProgramEnd run_cases(const Arguments& arguments, const std::filesystem::path& folder) {
    return run_program(Arguments{TESSERA_RANDOM_CASES} + arguments, folder);
}

}  // namespace

TEST_CASE("random case: read from its files it is the same as in memory") {
    const TestFolder here;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const RandomCase made = make_random_case(seed);
        made.write(here.path(), Mode::functional);
        Job job = read_job((here.path() / "job.toml").string());
        resolve_paths(job, {});
        const MachineSetup written = make_setup(job, load_mesh(job), load_map(job)), kept = made.setup();
        INFO("seed " << seed);
        CHECK(job.mode == Mode::functional);
        CHECK(written.map.codes == kept.map.codes);
        CHECK(written.registers.tests.height_thresholds == kept.registers.tests.height_thresholds);
        CHECK(written.registers.transform.row_w == kept.registers.transform.row_w);
        REQUIRE(written.base_triangles.size() == kept.base_triangles.size());
        for (std::size_t k = 0; k < kept.base_triangles.size(); ++k)
            for (std::size_t corner = 0; corner < 3; ++corner)
                REQUIRE(same(written.base_triangles[k].vertices[corner], kept.base_triangles[k].vertices[corner]));
    }
}

TEST_CASE("random case: a seed gives the same bytes from every compiler") {
    std::string text;
    for (std::uint64_t seed = 100; seed < 130; ++seed) {
        const RandomCase made = make_random_case(seed);
        text += made.mesh.obj + made.map.pgm() + made.summary();
    }
    CHECK(fnv1a(text) == 0xc5cf2fbac2c8fb56U);
}

TEST_CASE("random cases: meshes of every kind occur, and most of them are split") {
    std::set<std::string> kinds;
    std::size_t split = 0;
    constexpr std::uint64_t cases = 150;
    for (std::uint64_t seed = 1; seed <= cases; ++seed) {
        const RandomCase made = make_random_case(seed);
        kinds.insert(made.mesh.kind);
        const MachineSetup setup = made.setup();
        EmittedMesh mesh;
        CHECK(BareRecursion(setup).run(mesh) < RandomCase::most_edges);
        split += mesh.triangles.size() > 2 * setup.base_triangles.size() ? 1U : 0U;
    }
    CHECK(kinds == std::set<std::string>{"book", "cylinder", "fan", "grid", "mirrored pair", "slivers", "solid", "soup",
                                         "sphere", "torus"});
    CHECK(split > cases / 2);
}

TEST_CASE("invariants: parts of a folded patch that narrow formats merge are not cracks") {
    std::uint64_t folded = 0;
    for (const std::uint64_t seed : {141U, 149U, 240U, 403U, 610U, 673U, 729U, 791U, 809U, 898U, 940U, 978U, 987U}) {
        const MachineSetup setup = make_random_case(seed).setup();
        EmittedMesh mesh;
        BareRecursion(setup).run(mesh);
        const InvariantResult result = check_invariants(mesh, setup);
        INFO("seed " << seed << ": " << result.first_violation);
        CHECK(result.passed());
        folded += result.collapsed + result.turned_over;
    }
    CHECK(folded > 100);
}

TEST_CASE("the program writes a case that tessera runs, and lists its counts in one line") {
    const TestFolder here;
    const ProgramEnd written = run_cases({"--seed", "5", "--write", "case"}, here.path());
    INFO(written.text());
    REQUIRE(written.exit_code == 0);
    succeed({"run", "case/job.toml"}, here.path());
    const auto statistics = nlohmann::json::parse(read_all(here.path() / "run/statistics.json"));

    const ProgramEnd listed = run_cases({"--seed", "5", "--count", "1", "--list"}, here.path());
    INFO(listed.text());
    CHECK(listed.exit_code == 0);
    const std::string triangles = std::to_string(statistics["run"]["triangles_finished"]["value"].get<std::uint64_t>());
    CHECK_THAT(listed.out, Contains("seed 5: " + triangles + " triangles from "));
    CHECK_THAT(listed.out, Contains("1 cases: 0 cracks, 0 T-vertices, 0 other violations, 0 mismatches, 0 failed"));
}

TEST_CASE("the program of random cases refuses wrong usage") {
    const TestFolder here;
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--count", "0"}, {"--seed", "x"}, {"--nonsense"}, {"extra"}})
        CHECK(run_cases(arguments, here.path()).exit_code == 2);
    CHECK(run_cases({"--help"}, here.path()).exit_code == 0);
    CHECK(here.names().empty());
}
