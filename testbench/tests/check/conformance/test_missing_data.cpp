// Golden's own replacement of texels without a height.
#include <catch2/catch.hpp>
#include <string>

#include "testbench/machine/inputs.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using testing::SetupRun;

TEST_CASE("golden replaces missing data by itself, and notices a host that does so wrongly") {
    const TestFolder here;
    Job job;
    job.map.source = MapSource::file;
    job.map.path = here / "a.pgm";
    job.map.no_data = {65535};
    job.map.range.kind = GENERATE(MapRange::Kind::data, MapRange::Kind::full);
    std::string text = "P2 9 9 65535\n";
    for (int k = 0; k < 81; ++k)
        text += k % 7 == 3 ? "65535\n" : std::to_string(1000 + 13 * k) + "\n";
    write_all(job.map.path, text);
    const HeightMap right = load_map(job);
    REQUIRE(right.replaced.size() == 12);
    const auto passes = [&](const HeightMap& map) { return SetupRun(job, load_mesh(job), map).check().passed(); };
    CHECK(passes(right));
    INFO("ignored, by the host as a whole");
    Job without = job;
    without.map.no_data = {};
    CHECK_FALSE(passes(load_map(without)));
    INFO("one texel forgotten, given another height, or replaced though it had a height");
    HeightMap wrong = right;
    wrong.replaced.pop_back();
    wrong.values[right.replaced.back().texel] = right.replaced.back().was;
    CHECK_FALSE(passes(wrong));
    wrong = right;
    wrong.values[right.replaced[1].texel] += 20 / 65535.F;
    CHECK_FALSE(passes(wrong));
    wrong = right;
    wrong.replaced.push_back({80, wrong.values[80]});
    wrong.values[80] = wrong.values[79];
    CHECK_FALSE(passes(wrong));
}
