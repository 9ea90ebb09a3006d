// The promise of tests.bound_threshold: each of its conditions broken on purpose.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <regex>
#include <string>

#include "testbench/setup/bound_promise.h"
#include "testbench/tests/compare/bound_run.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

const std::string on_the_surface =
    "map.source=noise map.width=49 map.height=33 mesh.source=lattice mesh.spacing=16 displacement.scale=0.4 "
    "hardware.height_test=rank hardware.triangulation=greatest_rank formats.rank_bits=0 formats.bound_bits=8 "
    "tests.normal=false tests.view=false tests.bound_threshold=0.05 ";
const std::string in_the_picture =
    on_the_surface + "tests.rank_view=per_point hardware.test_order=cheap_first tests.bound_threshold=6 ";

struct Break {
    const char *condition, *settings;  ///< the condition's setting, or how it begins
    bool in_picture = false;
    const char* mended = nullptr;  ///< settings, where the condition is no `key = value`
};

const std::array breaks{
    Break{"hardware.height_test = ", "hardware.height_test=curvature hardware.triangulation=shorter"},
    Break{"formats.bound_bits = 8", "formats.rank_bits=8 formats.bound_bits=0"},
    Break{"tests.summed_height = ", "tests.summed_height=false"},
    Break{"hardware.triangulation = ", "hardware.triangulation=shorter"},
    Break{"mesh.source = ", "mesh.source=plane map.width=48 map.height=48"},
    Break{"a mesh.spacing that divides", "map.address_u=repeat map.width=40", false, "mesh.spacing=8"},
    Break{"formats.texture_fraction = ", "formats.texture_fraction=0"},
    Break{"tests.normal = ", "tests.normal=true tests.normal_threshold=0.1"},
    Break{"tests.highlight = ", "tests.highlight=true tests.highlight_angle=60"},
    Break{"tests.view = ", "tests.view=true tests.view_threshold=20"},
    Break{"tests.generation = ", "tests.generation_limit=4"},
    Break{"map.heights = ", "map.heights=fitted"},
    Break{"hardware.culling = ", "hardware.culling=back"},
    Break{"formats.bound_bits = 16", "formats.bound_bits=6 mesh.spacing=64 map.width=97 map.height=97", true},
    Break{"tests.bound_threshold above", "formats.displacement_bits=5 tests.bound_threshold=0.01", false,
          "formats.displacement_bits=16"},
};

/// `key = "value"` as an argument of --set.
std::string setting_of(std::string condition) {
    for (const char* const dropped : {" ", "\""})
        for (std::size_t at = 0; (at = condition.find(dropped)) != std::string::npos;)
            condition.erase(at, 1);
    return condition;
}

TEST_CASE("bound: with all conditions met it holds, and nothing else is said") {
    for (const std::string& settings : {on_the_surface, in_the_picture, on_the_surface + "formats.rank_bits=8",
                                        on_the_surface + "formats.bound_bits=16 tests.bound_threshold=0.2"}) {
        const BoundRun run(settings);
        INFO(settings << '\n' << run.words());
        CHECK(run.remark().empty());
        REQUIRE(run.result);
        CHECK(run.result->verdict == BoundResult::Verdict::holds);
        CHECK(run.result->promised);
        CHECK(run.result->points >= (run.result->in_picture ? 800 : 49 * 31));
        CHECK(run.result->deviation > run.result->threshold / 8);
        CHECK_THAT(run.result->text(), Contains("holds: ") && Contains("texel centres"));
    }
}

TEST_CASE("bound: PROMISES.md ends with the table of conditions") {
    std::string rows;
    for (const BoundCondition& condition : bound_conditions)
        rows += "| " + as_text(condition) + " | " + condition.why + " |\n";
    expect_section("testbench/check/PROMISES.md", "| holds with | without |\n| --- | --- |\n", rows);
}

TEST_CASE("bound: PROMISES.md names tests that exist") {
    const std::string sources = all_test_sources();
    const std::string programs = read_all(source_folder() / "testbench/tests/CMakeLists.txt");
    const std::string document = read_all(source_folder() / "testbench/check/PROMISES.md");
    const std::regex test("`(test_\\w+)`(?:: ([^;|]*[^;| ]))?");
    int named = 0;
    for (std::sregex_iterator found(document.begin(), document.end(), test), end; found != end; ++found) {
        const std::string words = (*found)[2];
        INFO((*found)[0]);
        CHECK(programs.find("tessera_add_test(" + (*found)[1].str() + ' ') != std::string::npos);
        CHECK(sources.find(words) != std::string::npos);
        named += words.empty() ? 0 : 1;
    }
    CHECK(named >= 20);
}

TEST_CASE("bound: a job that asks for none is not measured") {
    const BoundRun run("map.width=24 map.height=24");
    CHECK(run.remark().empty());
    CHECK_FALSE(run.result);
}

TEST_CASE("bound: fitted heights that are the map's own are said to have no effect, and keep it") {
    for (const char* const flat : {"map.source=constant", "displacement.scale=0"}) {
        const BoundRun run(on_the_surface + "map.heights=fitted " + flat);
        INFO(flat << '\n' << run.words());
        CHECK(std::any_of(run.setup.remarks.begin(), run.setup.remarks.end(), [](const std::string& remark) {
            return remark.rfind("map.heights = \"fitted\" has no effect: ", 0) == 0;
        }));
        CHECK(run.remark().empty());
        CHECK(run.result->verdict == BoundResult::Verdict::holds);
    }
}

TEST_CASE("bound: each condition, broken, is named with its remedy, and the remedy works") {
    std::size_t known = 0;
    for (const BoundCondition& condition : bound_conditions) {
        const std::string setting = condition.setting;
        const auto* const it = std::find_if(breaks.begin(), breaks.end(),
                                            [&](const Break& b) { return setting.rfind(b.condition, 0) == 0; });
        INFO(setting);
        REQUIRE(it != breaks.end());
        ++known;
        const std::string settings = (it->in_picture ? in_the_picture : on_the_surface) + it->settings + ' ';
        const BoundRun broken(settings);
        INFO(settings << '\n' << broken.words());
        CHECK_THAT(broken.remark(), Contains(condition.why));
        if (it->mended == nullptr)
            CHECK_THAT(broken.remark(), Contains("(set " + setting + ")"));
        if (broken.result) {
            CHECK_FALSE(broken.result->promised);
            CHECK(broken.result->passed());
            CHECK_THAT(broken.result->text(), Contains("not guaranteed"));
        }
        std::string remedies = it->mended != nullptr ? it->mended : "";
        if (it->mended == nullptr)
            for (const BoundCondition& other : bound_conditions)
                if (broken.remark().find("(set " + std::string(other.setting) + ")") != std::string::npos)
                    remedies += setting_of(other.setting) + ' ';
        const BoundRun mended(settings + remedies);
        INFO(mended.words());
        CHECK(mended.remark().empty());
        REQUIRE(mended.result);
        CHECK(mended.result->verdict == BoundResult::Verdict::holds);
    }
    CHECK(known == breaks.size());
}

TEST_CASE("bound: an edge without an error, a period from one that is bisected, lets it lapse") {
    const BoundRun run(
        on_the_surface +
        "map.source=text map.text=. map.width=20 map.height=22 map.address_u=repeat map.address_v=repeat "
        "mesh.spacing=8 ");
    INFO(run.words());
    CHECK(run.setup.rank_tables.clashes == 0);
    CHECK_THAT(run.remark(), Contains("midpoints share entries of the Rank Table"));
    CHECK_THAT(testing::joined(run.setup.remarks),
               Contains("it is longer than the map, and edges a period apart share"));
}

TEST_CASE("bound: the rounding of positions is named with a width that suffices") {
    for (const std::string& settings : {on_the_surface + "formats.bound_bits=16 tests.bound_threshold=0.1 ",
                                        in_the_picture + "tests.bound_threshold=3 "}) {
        const BoundRun coarse(settings + "formats.position_bits=10 formats.position_fraction=6");
        INFO(coarse.words());
        REQUIRE(coarse.result);
        CHECK(coarse.remark().empty());
        CHECK(coarse.result->verdict == BoundResult::Verdict::positions);
        const std::string remedy = coarse.result->remedy;
        CHECK_THAT(coarse.result->text(), Contains("set " + remedy));
        const BoundRun finer(settings + "formats.position_bits=10 formats.position_fraction=6 " + setting_of(remedy));
        INFO(finer.words());
        CHECK(finer.result->verdict == BoundResult::Verdict::holds);
    }
}

TEST_CASE("bound: in the picture a threshold of zero is exceeded by rounding, and one that is not is named") {
    for (const char* const settings : {"", "formats.position_bits=16 formats.position_fraction=0 "}) {
        const BoundRun zero(in_the_picture + settings + "tests.bound_threshold=0");
        INFO(zero.words());
        REQUIRE(zero.result);
        CHECK(zero.result->passed());
        CHECK_THAT(zero.result->remedy, Contains("tests.bound_threshold = "));
        const BoundRun larger(in_the_picture + settings + setting_of(zero.result->remedy));
        INFO(larger.words());
        CHECK(larger.result->verdict == BoundResult::Verdict::holds);
    }
}

TEST_CASE("bound: heights of few bits are inside the promise on the surface") {
    for (const char* const bits : {"8", "6", "5"}) {
        const BoundRun run(on_the_surface + "formats.bound_bits=16 formats.displacement_bits=" + bits);
        INFO(bits << '\n' << run.words());
        CHECK(run.result->verdict == BoundResult::Verdict::holds);
    }
}

TEST_CASE("bound: a mesh that is not the promised one fails the run") {
    BoundRun run(on_the_surface);
    for (glm::dvec3& position : run.mesh.positions)
        position.z += 0.03;
    // A fault is one of the height at its place, not of rounding.
    for (glm::dvec2& texture : run.mesh.textures)
        texture.x += 8.0 / 49;
    const auto wrong = check_bound(run.job, run.inputs.mesh, run.inputs.map, run.setup, run.mesh, false);
    REQUIRE(wrong);
    CHECK(wrong->verdict == BoundResult::Verdict::fault);
    CHECK_FALSE(wrong->passed());
    CHECK_THAT(wrong->text(), Contains("a fault of tessera"));
}

TEST_CASE("bound: with nothing of the mesh in the picture the check fails") {
    const BoundRun away(in_the_picture + "camera.eye=[0,-3,1] camera.target=[0,-6,1]");
    REQUIRE(away.result);
    CHECK(away.result->verdict == BoundResult::Verdict::nothing);
    CHECK_FALSE(away.result->passed());
    CHECK_THAT(away.result->text(), Contains("set camera.eye = \"auto\" and camera.target = \"auto\""));
    const BoundRun back(in_the_picture + "camera.eye=auto camera.target=auto");
    REQUIRE(back.result);
    CHECK(back.result->points > 0);
    CHECK(back.result->passed());
}

TEST_CASE("bound: the near plane between the map and the mesh is named") {
    BoundRun run(in_the_picture);
    BoundResult result = *run.result;
    result.verdict = BoundResult::Verdict::near_plane;
    CHECK_THAT(result.text(), Contains("lower camera.near_plane"));
}

}  // namespace
