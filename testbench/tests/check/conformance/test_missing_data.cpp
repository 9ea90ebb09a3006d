// Golden's own replacement of texels without a height.
#include <catch2/catch.hpp>
#include <string>

#include "testbench/machine/inputs.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using testing::SetupRun;

namespace {

struct Case {
    TestFolder here;
    Job job;
    HeightMap map;  // the host's

    explicit Case(MapRange::Kind range) {
        job.map.source = MapSource::file;
        job.map.path = here / "a.pgm";
        job.map.no_data = {65535};
        job.map.range.kind = range;
        std::string text = "P2 9 9 65535\n";
        for (int k = 0; k < 81; ++k)
            text += k % 7 == 3 ? "65535\n" : std::to_string(1000 + 13 * k) + "\n";
        write_all(job.map.path, text);
        map = load_map(job);
        REQUIRE(map.replaced.size() == 12);
    }
    bool passes() const { return SetupRun(job, load_mesh(job), map).check().passed(); }
};

}  // namespace

// One simulation a process, hence a test for each.

TEST_CASE("golden replaces missing data by itself as the host does, with the range of the data") {
    CHECK(Case(MapRange::Kind::data).passes());
}

TEST_CASE("golden replaces missing data by itself as the host does, with the full range") {
    CHECK(Case(MapRange::Kind::full).passes());
}

TEST_CASE("golden notices a host that ignores missing data") {
    Case wrong(MapRange::Kind::data);
    Job without = wrong.job;
    without.map.no_data = {};
    wrong.map = load_map(without);
    CHECK_FALSE(wrong.passes());
}

TEST_CASE("golden notices a host that forgets a texel without data") {
    Case wrong(MapRange::Kind::data);
    const HeightMap::Replaced forgotten = wrong.map.replaced.back();
    wrong.map.replaced.pop_back();
    wrong.map.values[forgotten.texel] = forgotten.was;
    CHECK_FALSE(wrong.passes());
}

TEST_CASE("golden notices a host that gives a texel without data another height") {
    Case wrong(MapRange::Kind::data);
    wrong.map.values[wrong.map.replaced[1].texel] += 20 / 65535.F;
    CHECK_FALSE(wrong.passes());
}

TEST_CASE("golden notices a host that replaces a height") {
    Case wrong(MapRange::Kind::data);
    wrong.map.replaced.push_back({80, wrong.map.values[80]});
    wrong.map.values[80] = wrong.map.values[79];
    CHECK_FALSE(wrong.passes());
}
