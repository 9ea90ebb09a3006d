#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <tuple>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/rank.h"
#include "testbench/compare/height_field.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/setup/thresholds.h"
#include "testbench/tests/setup/own_height_test.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tune/rank_curve.h"
#include "testbench/tune/threshold_level.h"
#include "testbench/tune/tune.h"
#include "testbench/tune/tune_report.h"
#include "testbench/tune/tuned_figures.h"

using namespace tessera;
using Catch::Contains;

namespace {

/// Half a donut on 18 triangles, small enough to try thousands of thresholds.
Job small_job() {
    Job job;
    job.map.width = 48;
    job.map.height = 40;
    job.displacement.scale = 0.25;
    job.tests.view = false;
    return load_inputs(job).resolved.job;
}

TuneRequest request_for(const Job& job) {
    TuneRequest request;
    request.job = job;
    request.bases.emplace_back();
    request.goal.most_triangles = 100000;
    return request;
}

TuneResult tuned(const TuneRequest& request) {
    return tune(request, load_map(request.job), [](const std::string&, double) {});
}

/// A job's tests, with everything needed to measure them.
struct Ground {
    HeightMap map;
    BaseMesh base;
    Job job;
    MachineSetup setup;
    TexelError errors;
    std::optional<RefinementForest> forest;  // unless of a Rank Test

    explicit Ground(const Job& the_job)
        : map(load_map(the_job)),
          base(load_mesh(the_job)),
          job(resolve_job(the_job, base, map).job),
          setup(make_setup(job, base, map)),
          errors(setup, map, DisplacementOf::from(job, map)) {
        if (job.hardware.height_test != HeightTest::rank)
            forest.emplace(setup, &errors);
    }

    Outcome measure(const Job& of) {
        return forest->measure(make_tests(of.tests, setup.registers.formats), setup.registers.triangulation, 1000000);
    }
};

using Corners = std::array<std::array<std::int64_t, 5>, 3>;

Corners corners_of(const std::array<datapath::Vertex, 3>& vertices) {
    Corners corners{};
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& v = vertices[k];
        corners[k] = {v.texture.u, v.texture.v, v.displaced.x, v.displaced.y, v.displaced.z};
    }
    return corners;
}

std::multiset<Corners> bare_mesh(const MachineSetup& setup) {
    EmittedMesh mesh;
    BareRecursion(setup).run(mesh);
    std::multiset<Corners> result;
    for (const EmittedTriangle& t : mesh.triangles) {
        std::array<datapath::Vertex, 3> vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[k].texture = t.corners[k].texture;
            vertices[k].displaced = t.corners[k].displaced;
        }
        result.insert(corners_of(vertices));
    }
    return result;
}

/// The best point of a dense grid of both thresholds, each test also alone.
TunedPoint brute_force(const Job& job, const TuneGoal& goal) {
    Ground ground(job);
    TunedPoint best;
    bool found = false;
    constexpr int step = levels_per_octave / 8;
    const auto attempt = [&](const Job& trial) {
        TunedPoint point;
        point.tests = trial.tests;
        point.outcome = ground.measure(trial);
        const bool meets =
            goal.triangles > 0 ? point.outcome.triangles <= goal.triangles : goal.error_of(point.outcome) <= goal.error;
        if (meets && (!found || better(point, best, goal))) {
            best = point;
            found = true;
        }
    };
    for (int normal = -8 * levels_per_octave; normal <= levels_per_octave + step; normal += step)
        for (int sum = -8 * levels_per_octave; sum <= 5 * levels_per_octave + step; sum += step) {
            Job trial = job;
            trial.tests.normal = normal <= levels_per_octave;
            trial.tests.summed_height = sum <= 5 * levels_per_octave;
            if (trial.tests.normal)
                trial.tests.normal_threshold = threshold_at(normal);
            if (trial.tests.summed_height)
                trial.tests.threshold("summed_height_threshold") = threshold_at(sum);
            if (trial.tests.normal || trial.tests.summed_height)
                attempt(trial);
        }
    REQUIRE(found);
    return best;
}

}  // namespace

TEST_CASE("threshold levels rise and are invertible") {
    CHECK(threshold_at(0) == 1);
    CHECK(threshold_at(levels_per_octave) == 2);
    CHECK(threshold_at(-3 * levels_per_octave) == 0.125);
    CHECK(threshold_at(levels_per_octave / 2) == 1.4142);
    for (int level = -20000; level < 20000; level += 37) {
        const double threshold = threshold_at(level);
        CHECK(threshold < threshold_at(level + 1));
        CHECK(level_of(threshold) == level);
        CHECK(level_of(threshold * 1.00001) == level + 1);
    }
}

TEST_CASE("the forest's mesh is the datapath's for any thresholds") {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return low * std::pow(high / low, static_cast<double>(random()) / 4294967295.0);
    };
    for (const MeshSource source : {MeshSource::plane, MeshSource::cylinder}) {
        Job job = small_job();
        job.mesh.source = source;
        if (source == MeshSource::cylinder) {
            job.map.address_u = Addressing::repeat;
            job.displacement.scale = 0.1;
        }
        job.tests.view = true;
        Ground ground(job);
        for (int round = 0; round < 60; ++round) {
            Job::Tests& tests = job.tests;
            tests.normal = round % 7 != 1;
            tests.summed_height = round % 7 != 2;
            tests.tex_coord = round % 7 != 3;
            tests.view = round % 2 == 0;
            tests.normal_threshold = between(0.01, 1);
            tests.summed_height_unit = round % 3 == 0 ? SummedHeightUnit::area : SummedHeightUnit::sum;
            tests.threshold("summed_height_threshold") =
                tests.summed_height_unit == SummedHeightUnit::area ? between(0.002, 0.5) : between(0.02, 10);
            tests.view_threshold = between(1, 200);
            tests.generation_limit = 1 + round % 9;
            job.hardware.triangulation = static_cast<Triangulation>(round % 3);
            const MachineSetup setup = make_setup(job, ground.base, ground.map);
            std::multiset<Corners> mesh;
            for (const auto& vertices : ground.forest->mesh(setup.registers.tests, setup.registers.triangulation))
                mesh.insert(corners_of(vertices));
            INFO("round " << round << ", " << mesh.size() << " triangles");
            CHECK((mesh == bare_mesh(setup)));  // extra parentheses: a failure prints no meshes
            CHECK(ground.forest->count(setup.registers.tests, setup.registers.triangulation, mesh.size()).complete);
            CHECK_FALSE(
                ground.forest->count(setup.registers.tests, setup.registers.triangulation, mesh.size() - 1).complete);
        }
    }
}

TEST_CASE("the search's error on a height field is the vertical error") {
    Job job = small_job();
    job.mesh.columns = 5;  // some vertices on the texel grid, others off it
    job.mesh.rows = 4;
    for (const double threshold : {2.0, 0.3, 0.05}) {
        job.tests.normal_threshold = threshold;
        Ground ground(job);
        EmittedMesh mesh;
        BareRecursion(ground.setup).run(mesh);
        const Outcome outcome = ground.measure(job);
        const TunedFigures figures = measure_tuned(job, ground.base, ground.map, ground.setup, mesh);
        CHECK(figures.what == "vertical error");
        CHECK(outcome.triangles == figures.triangles);
        CHECK(outcome.rms == Approx(figures.rms_model).epsilon(1e-3));
        CHECK(outcome.max == Approx(figures.max_model).epsilon(1e-3));
    }
}

TEST_CASE("no budget is exceeded, and no dense grid of thresholds is better") {
    Job job = small_job();
    for (const bool largest : {false, true})
        for (const std::uint64_t budget : {18u, 60u, 200u, 700u, 1500u}) {
            TuneRequest request = request_for(job);
            request.space.summed_height_unit = request.space.triangulation = request.space.generation_limit = false;
            request.goal.triangles = budget;
            request.goal.largest = largest;
            const TunedPoint point = tuned(request).point;
            const TunedPoint brute = brute_force(job, request.goal);
            INFO("budget " << budget << ", largest " << largest << ": " << point.outcome.triangles << " triangles "
                           << request.goal.error_of(point.outcome) << ", brute force " << brute.outcome.triangles
                           << " triangles " << request.goal.error_of(brute.outcome) << " at "
                           << brute.tests.normal_threshold << " " << brute.tests.threshold("summed_height_threshold")
                           << " against " << point.tests.normal << point.tests.normal_threshold << " "
                           << point.tests.threshold("summed_height_threshold"));
            CHECK(point.outcome.triangles <= budget);
            CHECK(request.goal.error_of(point.outcome) <= 1.03 * request.goal.error_of(brute.outcome));
        }
}

TEST_CASE("tuned thresholds keep a distance from every edge's own value") {
    for (const bool both : {true, false})
        for (const std::uint64_t budget : {100u, 300u, 600u, 900u}) {
            TuneRequest request = request_for(small_job());
            request.space.summed_height = both;
            request.job.tests.summed_height = both;
            request.goal.triangles = budget;
            TuneResult result = tuned(request);
            const Outcome& outcome = result.point.outcome;
            Ground ground(result.job);
            INFO("budget " << budget << ", both " << both);
            const auto searched = [](Job::Tests& tests, bool normal) -> double& {
                return normal ? tests.normal_threshold : tests.threshold("summed_height_threshold");
            };
            for (const bool normal : {true, false})
                if (const double threshold = searched(result.job.tests, normal); threshold > 0) {
                    const int level = level_of(threshold);
                    // the number of levels on one side that give the same mesh
                    const auto room = [&](int direction) {
                        int steps = 0;
                        for (Job job = result.job; steps < 8; ++steps) {
                            searched(job.tests, normal) = threshold_at(level + direction * (steps + 1));
                            const Outcome moved = ground.measure(job);
                            if (moved.triangles != outcome.triangles || moved.rms != outcome.rms)
                                break;
                        }
                        return steps;
                    };
                    const int below = room(-1), above = room(1);
                    INFO(below << " levels below, " << above << " above");
                    CHECK(std::abs(below - above) <= 1);
                }
        }
}

TEST_CASE("an error's bound is met with about as few triangles as a dense grid finds") {
    const Job job = small_job();
    for (const double bound : {0.03, 0.015, 0.011}) {
        TuneRequest request = request_for(job);
        request.space.summed_height_unit = request.space.triangulation = request.space.generation_limit = false;
        request.goal.error = bound;
        const TunedPoint point = tuned(request).point;
        const TunedPoint brute = brute_force(job, request.goal);
        INFO("bound " << bound << ": " << point.outcome.triangles << " triangles, brute force "
                      << brute.outcome.triangles);
        CHECK(point.outcome.rms <= bound);
        CHECK(static_cast<double>(point.outcome.triangles) <= 1.03 * static_cast<double>(brute.outcome.triangles));
    }
}

TEST_CASE("a View Test in the search is used, also alone") {
    TuneRequest request = request_for(small_job());
    request.job.tests.view = true;
    request.goal.triangles = 400;
    request.space.view = true;
    const TuneResult all = tuned(request);
    CHECK(all.point.outcome.triangles <= 400);
    request.space.view = false;
    const TuneResult fixed = tuned(request);
    CHECK(fixed.point.tests.view_threshold == request.job.tests.view_threshold);
    CHECK(all.point.outcome.rms <= fixed.point.outcome.rms);
    request.space.view = true;
    request.space.normal = request.space.summed_height = request.space.generation_limit = false;
    request.job.tests.normal_threshold = request.job.tests.threshold("summed_height_threshold") = 0.05;
    const TuneResult alone = tuned(request);
    CHECK(alone.point.tests.normal_threshold == request.job.tests.normal_threshold);
    CHECK(alone.point.tests.view_threshold > 0);
    CHECK(alone.point.outcome.triangles <= 400);
    CHECK(alone.point.outcome.triangles > 300);
}

TEST_CASE("a Rank Test's threshold is the best of all values of its register") {
    for (const bool largest : {false, true}) {
        TuneRequest request = request_for(small_job());
        request.bases = rank_lattices(request.job, 48, 40, 100);
        REQUIRE(request.bases.size() == 5);  // 8 to 128 texels
        request.bases = {request.bases[1]};
        request.goal.largest = largest;
        Job job = job_with_base(request.job, request.bases.front(), request.goal);
        Ground ground(job);
        RankSearch search(ground.setup, ground.job, ground.errors, request.goal);
        std::vector<Outcome> all;
        for (std::uint32_t threshold = 0; threshold <= search.highest(); ++threshold) {
            (largest ? job.tests.threshold("bound_threshold") : job.tests.threshold("rank_threshold")) =
                search.threshold_of(threshold);
            const MachineSetup setup = make_setup(job, ground.base, ground.map);
            CHECK(setup.registers.tests.height_thresholds[largest ? datapath::bound_number : datapath::rank_number] ==
                  threshold);
            EmittedMesh mesh;
            BareRecursion(setup).run(mesh);
            mesh.sort();
            const TunedFigures figures = measure_tuned(job, ground.base, ground.map, setup, mesh);
            all.push_back(search.outcome(threshold, 100000, true));
            CHECK(all.back().triangles == figures.triangles);
            // The search leaves out some of the points on the mesh's border.
            CHECK(all.back().rms == Approx(figures.rms_model).epsilon(0.05));
            CHECK(all.back().max <= Approx(figures.max_model).epsilon(1e-3));
        }
        for (const std::uint64_t budget : {20u, 60u, 200u, 700u}) {
            request.goal.triangles = budget;
            std::uint64_t most = 0;
            for (const Outcome& outcome : all)
                most = std::max(most, outcome.triangles <= budget ? outcome.triangles : 0);
            INFO("at most " << budget << " triangles, largest " << largest);
            CHECK(tuned(request).point.outcome.triangles == most);
        }
        request.goal.triangles = 0;
        for (const double bound : {0.03, 0.015, 0.011}) {
            request.goal.error = bound;
            const TunedPoint point = tuned(request).point;
            INFO("error of at most " << bound << ", largest " << largest);
            CHECK(request.goal.error_of(point.outcome) <= bound);
            if (largest) {  // the register promises it, by less than an entry's step
                job.tests.threshold("bound_threshold") = point.tests.threshold("bound_threshold");
                const MachineSetup setup = make_setup(job, ground.base, ground.map);
                const auto threshold =
                    static_cast<std::uint32_t>(setup.registers.tests.height_thresholds[datapath::bound_number]);
                const double promised = bound_error(threshold, setup.registers.formats.bound_bits) *
                                        std::abs(setup.height_per_code) / setup.scale;
                CHECK(promised <= bound);
                CHECK(promised > 0.9 * bound);
                continue;
            }
            std::uint64_t fewest = 100000;
            for (const Outcome& outcome : all)
                fewest = std::min(fewest, outcome.rms <= bound ? outcome.triangles : fewest);
            CHECK(point.outcome.triangles == fewest);
        }
    }
}

TEST_CASE("a Curvature or a Mipmap Test's threshold is tuned, alone and beside the Normal Test") {
    TuneRequest request = request_for(small_job());
    for (const auto& [test, normal] : {std::pair{datapath::number_of<datapath::CurvatureTest>(), false},
                                       {datapath::number_of<datapath::CurvatureTest>(), true},
                                       {datapath::number_of<datapath::MipmapTest>(), false},
                                       {datapath::number_of<datapath::MipmapTest>(), true}}) {
        request.job.hardware.height_test = test;
        request.job.tests.normal = request.space.normal = normal;
        request.goal.triangles = 300;
        const TuneResult result = tuned(request);
        CHECK(result.point.outcome.triangles <= 300);
        CHECK(result.point.outcome.triangles >= 150);
        CHECK(result.point.tests.threshold("summed_height_threshold") ==
              request.job.tests.threshold("summed_height_threshold"));
        Ground ground(result.job);
        EmittedMesh mesh;
        BareRecursion(ground.setup).run(mesh);
        CHECK(mesh.triangles.size() == result.point.outcome.triangles);
        if (normal)
            continue;
        // No threshold of a dense grid does better.
        for (int level = -14 * levels_per_octave; level <= 2 * levels_per_octave; level += levels_per_octave / 16) {
            Job job = result.job;
            job.tests.threshold("curvature_threshold") = threshold_at(level);
            job.tests.threshold("mipmap_threshold") = std::min(1.0, threshold_at(level));
            const Outcome outcome = ground.measure(job);
            if (outcome.triangles <= 300)
                CHECK(outcome.rms >= 0.999 * result.point.outcome.rms);
        }
    }
}

TEST_CASE("a Rank Table's file has each texel's rank and bound, little endian") {
    TuneRequest request = request_for(small_job());
    request.bases = rank_lattices(request.job, 48, 40, 100);
    Job job = job_with_base(request.job, request.bases.front(), request.goal);
    job.formats.rank_bits = 10;
    job.formats.bound_bits = 7;
    Ground ground(job);
    const std::string bytes = rank_table_bytes(ground.setup);
    const RankTables& tables = ground.setup.rank_tables;
    REQUIRE(bytes.size() == tables.rank.size() * 3);
    for (std::size_t k = 0; k < tables.rank.size(); ++k) {
        const auto byte = [&](std::size_t n) { return unsigned{static_cast<unsigned char>(bytes[3 * k + n])}; };
        CHECK((byte(0) | byte(1) << 8 | byte(2) << 16) == (tables.rank[k] | unsigned{tables.bound[k]} << 10));
    }
}

TEST_CASE("the better of the paper's tests and a Rank Test is chosen") {
    TuneRequest request = request_for(small_job());
    for (const BaseChoice& base : rank_lattices(request.job, 48, 40, 200))
        request.bases.push_back(base);
    bool ranks_won = false;
    for (const std::uint64_t budget : {18u, 60u, 300u}) {
        request.goal.triangles = budget;
        const TuneResult result = tuned(request);
        const bool ranks = request.bases[result.base].ranks;
        ranks_won = ranks_won || ranks;
        CHECK((result.job.hardware.height_test == HeightTest::rank) == ranks);
        CHECK((result.job.mesh.source == MeshSource::lattice) == ranks);
        for (const TriedPoint& tried : result.tried)
            CHECK_FALSE(better(tried.point, result.point, request.goal));
    }
    CHECK(ranks_won);
}

TEST_CASE("the result does not depend on the number of threads") {
    TuneRequest request = request_for(small_job());
    request.goal.triangles = 500;
    const HeightMap map = load_map(request.job);
    for (const BaseChoice& base : usual_bases(request.job.mesh, map.width, map.height, 250))
        request.bases.push_back(base);
    REQUIRE(request.bases.size() > 4);
    const auto text = [&](unsigned threads) {
        request.threads = threads;
        const TuneResult result = tuned(request);
        TunedFigures figures;
        figures.triangles = result.point.outcome.triangles;
        figures.rms = result.point.outcome.rms;
        return tune_json(request, result, figures, {}) + tried_csv(request, result, {});
    };
    const std::string one = text(1);
    CHECK(text(3) == one);
    CHECK(text(16) == one);
}

TEST_CASE("a lattice has its inner vertices at texel centres and covers the map") {
    for (const std::int64_t texels : {1, 5, 31, 32, 33, 336, 459})
        for (const std::int64_t spacing : {1, 4, 32}) {
            const std::vector<double> lines = lattice_lines(texels, spacing);
            INFO(texels << " texels, spacing " << spacing);
            REQUIRE(lines.size() >= 2);
            CHECK(lines.front() == 0);
            CHECK(lines.back() == static_cast<double>(texels));
            for (std::size_t k = 1; k < lines.size(); ++k) {
                const double cell = lines[k] - lines[k - 1];
                const bool inner = k > 1 && k + 1 < lines.size();
                CHECK((inner ? cell == static_cast<double>(spacing) : cell > 0));
                if (k + 1 < lines.size())
                    CHECK(lines[k] - std::floor(lines[k]) == 0.5);
            }
        }
    Job::Mesh mesh;
    mesh.width = 3;
    mesh.depth = 4;
    for (const bool alternate : {false, true}) {
        const BaseChoice choice = lattice_choice(8, alternate, 48, 40);
        const BaseMesh base = parse_obj(lattice_obj(choice, mesh, 48, 40), "lattice");
        CHECK(base.triangles.size() == choice.triangles());
        CHECK(base.repairs.empty());
        double area = 0;
        for (const auto& t : base.triangles) {
            const glm::dvec3 a = base.vertices[t[0]].position, b = base.vertices[t[1]].position,
                             c = base.vertices[t[2]].position;
            const double signed_area = glm::cross(b - a, c - a).z / 2;
            CHECK(signed_area > 0);
            area += signed_area;
        }
        CHECK(area == Approx(12));
        HeightMap map;
        map.width = 48;
        map.height = 40;
        std::string why;
        CHECK(find_height_field(base, map, {}, why));
    }
}

TEST_CASE("goals that cannot be met are refused with the nearest that can") {
    TuneRequest request = request_for(small_job());
    const auto refused = [&] { return testing::input_error_of([&] { tuned(request); }); };
    request.goal.triangles = 17;
    CHECK_THAT(refused(), Contains("--triangles 17") && Contains("18 triangles"));
    Job finest = request.job;
    finest.tests.normal_threshold = finest.tests.threshold("summed_height_threshold") = 0;
    const Outcome most = Ground(finest).measure(finest);
    request.goal.triangles = most.triangles;
    CHECK(refused().empty());
    request.goal.triangles = most.triangles + 1;
    CHECK_THAT(refused(), Contains("at most " + std::to_string(most.triangles)));
    request.goal.triangles = 0;
    request.goal.error = 1e-6;
    CHECK_THAT(refused(), Contains("--error") && Contains("the least RMS error"));
    // The test that is not searched keeps the mesh too large.
    request.goal.error = 0;
    request.goal.triangles = 100;
    request.space.summed_height = false;
    request.job.tests.threshold("summed_height_threshold") = 0;
    CHECK_THAT(refused(), Contains("--triangles 100") && Contains("at any of the thresholds"));
}

TEST_CASE("an own height test that decides otherwise than by its compared value is not searched") {
    struct Always : testing::OwnTest {
        void decide(const datapath::HeightEdge& edge, const datapath::Entries& entries, const datapath::Registers& r,
                    datapath::HeightDecision& decision) const override {
            OwnTest::decide(edge, entries, r, decision);
            decision.asks = true;
        }
    };
    static const Always test;
    static const testing::OwnHost host;
    const HeightTest added = datapath::add_height_test(test);
    add_height_test_host(host);
    Job job = small_job();
    job.hardware.height_test = added;
    CHECK_THROWS_WITH(
        Ground(job),
        "height test own: decide() asks for a split of an edge whose value value = 0 has the limit() 2047");
}
