#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "testbench/check/mesh/invariants.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/prove/random_machines/lineage_check.h"
#include "testbench/prove/random_machines/random_case.h"
#include "testbench/tests/support/program_runner.h"

/// The generator of random cases and its program; that the cases hold is what tessera_random_cases itself is run for.
using namespace tessera;
using Catch::Contains;

namespace {

bool same(const datapath::Vertex& a, const datapath::Vertex& b) {
    return a.position == b.position && a.normal == b.normal && a.tangent == b.tangent &&
           a.texture == b.texture && a.handedness == b.handedness;
}

std::uint64_t digest(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return hash;
}

ProgramEnd run_cases(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
    std::vector<std::string> command{TESSERA_RANDOM_CASES};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_program(command, folder);
}

}  // namespace

TEST_CASE("random case: from its files it is the same as from memory") {
    const TestFolder here;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const RandomCase made = make_random_case(seed);
        made.write(here.path(), Mode::functional);
        const Job job = read_job((here.path() / "job.toml").string());
        const MachineSetup written = make_setup(job, load_mesh(job), load_map(job)), kept = made.setup();
        INFO("seed " << seed);
        CHECK(job.mode == Mode::functional);
        CHECK(written.map.codes == kept.map.codes);
        CHECK(written.registers.tests.summed_height_threshold ==
              kept.registers.tests.summed_height_threshold);
        CHECK(written.registers.transform.row_w == kept.registers.transform.row_w);
        REQUIRE(written.base_triangles.size() == kept.base_triangles.size());
        for (std::size_t k = 0; k < kept.base_triangles.size(); ++k)
            for (std::size_t corner = 0; corner < 3; ++corner)
                REQUIRE(same(written.base_triangles[k].vertices[corner],
                             kept.base_triangles[k].vertices[corner]));
    }
}

TEST_CASE("random case: a seed gives the same bytes from every compiler") {
    std::string text;
    for (std::uint64_t seed = 100; seed < 130; ++seed) {
        const RandomCase made = make_random_case(seed);
        text += made.mesh.obj + made.map.pgm() + made.summary();
    }
    CHECK(digest(text) == 0x09111fe19677cd64U);
}

TEST_CASE("random cases: meshes of every kind, most of them split") {
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
    CHECK(kinds == std::set<std::string>{"book", "cylinder", "fan", "grid", "mirrored pair", "slivers",
                                         "solid", "soup", "sphere", "torus"});
    CHECK(split > cases / 2);
}

/// Narrow positions on which edges or base vertices of a folded patch fall into one place: no cracks, which
/// the check by descent says without looking at places.
TEST_CASE("invariants: what rounding puts into one place of a folded patch is no crack") {
    std::uint64_t coincident = 0;
    for (const std::uint64_t seed :
         {141U, 149U, 240U, 403U, 610U, 673U, 729U, 791U, 809U, 898U, 940U, 978U, 987U}) {
        const RandomCase made = make_random_case(seed);
        const MachineSetup setup = made.setup();
        EmittedMesh mesh;
        BareRecursion(setup).run(mesh);
        const InvariantResult result = check_invariants(mesh, setup.base_triangles, setup.registers);
        INFO("seed " << seed << ": " << result.first_violation);
        CHECK(result.passed());
        CHECK(check_lineage(setup).passed());
        coincident += result.coincident_edges + result.coincident_vertices;
    }
    CHECK(coincident > 100);
}

TEST_CASE("lineage: two triangles close along their edge, and with an end that differs each fault is named") {
    RandomCase made;
    made.job.tests.view = false;
    made.job.tests.summed_height_threshold = 0.1;
    made.map.width = made.map.height = 16;
    Random random(5);
    for (int k = 0; k < 256; ++k)
        made.map.samples.push_back(static_cast<std::uint16_t>(random.natural(0, 65535)));
    made.mesh.obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.4\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
        "f 1/1 2/2 3/3\nf 2/2 4/4 3/3\n";
    made.job = resolve_job(made.job, made.base_mesh(), made.height_map()).job;
    const MachineSetup setup = made.setup();
    const LineageResult whole = check_lineage(setup);
    INFO(whole.first_fault);
    CHECK(whole.passed());
    CHECK(whole.first_fault.empty());
    CHECK(whole.triangles > 100);

    // One copy of a shared vertex is of the last generation: its triangle keeps the common edge whole.
    MachineSetup older = setup;
    older.base_triangles[1].vertices[0].generation =
        static_cast<std::uint8_t>(setup.registers.tests.generation_limit);
    const LineageResult unlike = check_lineage(older);
    CHECK(unlike.t_vertices == 1);
    CHECK(unlike.unlike_vertices == 1);
    CHECK(unlike.cracks > 0);  // pieces of the other side's halves, which nobody meets
    CHECK_THAT(unlike.first_fault, Contains("a vertex comes out differently from two sides"));

    // Of a base triangle that is there twice each edge is wanted twice, and found twice.
    MachineSetup twice = setup;
    twice.base_triangles.push_back(setup.base_triangles[0]);
    CHECK(check_lineage(twice).passed());
}

TEST_CASE("the program leaves a case that tessera runs, and says of a line what it ran") {
    const TestFolder here;
    const ProgramEnd written = run_cases({"--seed", "5", "--write", "case"}, here.path());
    INFO(written.text());
    REQUIRE(written.exit_code == 0);
    const ProgramEnd ran = run_tessera({"run", "case/job.toml"}, here.path());
    INFO(ran.text());
    REQUIRE(ran.exit_code == 0);
    const auto statistics = nlohmann::json::parse(read_all(here.path() / "run/statistics.json"));

    const ProgramEnd listed = run_cases({"--seed", "5", "--count", "1", "--list"}, here.path());
    INFO(listed.text());
    CHECK(listed.exit_code == 0);
    const std::string triangles =
        std::to_string(statistics["run"]["triangles_finished"]["value"].get<std::uint64_t>());
    CHECK_THAT(listed.out, Contains("seed 5: " + triangles + " triangles from "));
    CHECK_THAT(listed.out,
               Contains("1 cases: 0 cracks, 0 T-vertices, 0 other violations, 0 mismatches, 0 failed"));
}

TEST_CASE("the program of random cases refuses wrong usage") {
    const TestFolder here;
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--count", "0"}, {"--seed", "x"}, {"--nonsense"}, {"extra"}})
        CHECK(run_cases(arguments, here.path()).exit_code == 2);
    CHECK(run_cases({"--help"}, here.path()).exit_code == 0);
    CHECK(here.names().empty());
}
