// The promise of tests.bound_threshold: 300 jobs at random over all keys, measured apart from the program's own
// measurement. Whenever the mesh is farther away than promised, one line names the key.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/common/random.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/encode_height_map.h"
#include "testbench/job/job_keys.h"
#include "testbench/tests/compare/bound_run.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

struct Deviation {
    double largest = 0;   // full scale, or pixels
    bool covered = true;  // every texel centre is in a triangle: none is on the mesh's border, moved off it by rounding
};

/// The texels whose centres lie on the base mesh along an axis; a repeated map's copies too, a clamped one's own only.
std::pair<int, int> texels_along(const BaseMesh& mesh, int axis, double size, int texels, Addressing addressing) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const BaseVertex& vertex : mesh.vertices) {
        const double texel = (vertex.position[axis] / size + 0.5) * texels - 0.5;
        low = std::min(low, texel);
        high = std::max(high, texel);
    }
    const int first = static_cast<int>(std::ceil(low - 1e-6)), last = static_cast<int>(std::floor(high + 1e-6));
    return addressing == Addressing::repeat ? std::pair{first, last}
                                            : std::pair{std::max(first, 0), std::min(last, texels - 1)};
}

/// The largest deviation over the texel centres in the mesh's triangles by brute force, on a plane of mesh.width by
/// mesh.depth at z = 0.
Deviation brute_force_deviation(const BoundRun& run) {
    const Job& job = run.job;
    const HeightMap& map = run.inputs.map;
    const double span = map.span_high - map.span_low;
    const double per_value = span > 0 ? job.displacement.scale / span : 0;
    const double full = std::abs(per_value * (map.range_high - map.range_low));
    const bool pixels = job.tests.rank_view != RankView::none;
    const auto vector = [](const std::array<double, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    const glm::dvec3 eye = vector(job.camera.eye), ahead = glm::normalize(vector(job.camera.target) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, vector(job.camera.up))), up = glm::cross(right, ahead);
    const double w = static_cast<double>(job.camera.viewport_width),
                 h = static_cast<double>(job.camera.viewport_height);
    const double focal = h / 2 / std::tan(job.camera.field_of_view / 360 * 3.14159265358979323846);
    const auto seen = [&](const glm::dvec3& p) {
        const glm::dvec3 d = p - eye;
        return glm::dvec2(glm::dot(d, right), glm::dot(d, up)) * focal / glm::dot(d, ahead);
    };
    const auto in_front = [&](const glm::dvec3& p) { return glm::dot(p - eye, ahead) > job.camera.near_plane; };
    const auto [left_most, right_most] = texels_along(run.inputs.mesh, 0, job.mesh.width, map.width, job.map.address_u);
    const auto [lowest, highest] = texels_along(run.inputs.mesh, 1, job.mesh.depth, map.height, job.map.address_v);
    double largest = 0;
    std::set<std::pair<int, int>> covered;
    for (const RecordedMesh::Triangle& triangle : run.mesh.triangles) {
        const auto c = run.mesh.corners(triangle);
        const auto [left, r] = std::minmax({c[0].x, c[1].x, c[2].x});
        const auto [bottom, top] = std::minmax({c[0].y, c[1].y, c[2].y});
        const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
        if (area == 0)
            continue;
        for (int row = lowest; row <= highest; ++row) {
            const double y = job.mesh.depth * ((row + 0.5) / map.height - 0.5);
            if (y < bottom || y > top)
                continue;
            for (int column = left_most; column <= right_most; ++column) {
                const double x = job.mesh.width * ((column + 0.5) / map.width - 0.5);
                if (x < left || x > r)
                    continue;
                const auto part = [&](std::size_t a, std::size_t b) {
                    return ((c[b].x - c[a].x) * (y - c[a].y) - (c[b].y - c[a].y) * (x - c[a].x)) / area;
                };
                const double p0 = part(1, 2), p1 = part(2, 0), p2 = part(0, 1);
                if (std::min({p0, p1, p2}) < 0)
                    continue;
                covered.insert({column, row});
                const double z = p0 * c[0].z + p1 * c[1].z + p2 * c[2].z;
                const auto value = static_cast<double>(map.at(column % map.width, row % map.height));
                const double wanted = job.displacement.bias + per_value * (value - map.span_low);
                const glm::dvec3 of_map(x, y, wanted), of_mesh(x, y, z);
                if (!pixels) {
                    largest = std::max(largest, full > 0 ? std::abs(z - wanted) / full : 0);
                    continue;
                }
                if (!in_front(of_map) || std::abs(seen(of_map).x) > w / 2 || std::abs(seen(of_map).y) > h / 2)
                    continue;
                largest = std::max(largest, in_front(of_mesh) ? glm::length(seen(of_mesh) - seen(of_map)) : HUGE_VAL);
            }
        }
    }
    return {largest, static_cast<int>(covered.size()) == (right_most - left_most + 1) * (highest - lowest + 1)};
}

/// Map files of every format, with missing data in some, and settings that read them.
std::vector<std::string> write_maps(const TestFolder& folder, Random& random) {
    std::vector<std::string> settings;
    for (const MapFormat format : {MapFormat::pgm, MapFormat::png, MapFormat::exr})
        for (const bool holes : {false, true}) {
            const auto width = static_cast<int>(random.integer(17, 50)),
                       height = static_cast<int>(random.integer(17, 50));
            const HeightMap noise = noise_map(width, height, random.natural(0, 1000));
            std::vector<double> heights(noise.values.begin(), noise.values.end());
            for (double& z : heights)
                z = holes && random.chance(2) ? -9 : 10 * z;  // the lowest is sample 0
            const std::string name =
                (folder / ("map" + std::to_string(settings.size()))).string() + (format == MapFormat::pgm   ? ".pgm"
                                                                                 : format == MapFormat::png ? ".png"
                                                                                                            : ".exr");
            write_all(name, encode_height_map(width, height, heights, format).bytes);
            settings.push_back("map.file=" + name + ' ' +
                               (!holes                     ? ""
                                : format == MapFormat::exr ? "map.no_data=-9 "
                                                           : "map.no_data=0 "));
        }
    const std::string bytes = (folder / "bytes.pgm").string();
    std::string text = "P2 40 21 250\n";
    for (int k = 0; k < 40 * 21; ++k)
        text += std::to_string(random.integer(0, 250)) + '\n';
    write_all(bytes, text);
    settings.push_back("map.file=" + bytes + ' ');
    settings.push_back("map.file=" + bytes + " map.no_data=[250,0] ");
    return settings;
}

/// A value for a key, at random, near its default as often as at an end of its range; empty for a file or a text.
std::string any_value(Random& random, const tessera::Key& key) {
    const JobValue normal = default_of(key);
    const auto scaled = [&](double value) {
        return std::clamp(value * std::exp2(random.real(-2, 2)), key.range.low, key.range.high);
    };
    const unsigned choice = random.natural(0, 3);
    std::ostringstream text;
    text.precision(17);
    switch (key.kind) {
        case KeyKind::flag: return random.coin() ? "true" : "false";
        case KeyKind::choice: return std::string(key.choices[random.bits() % key.choices.size()]);
        case KeyKind::integer: {
            const double about = static_cast<double>(std::get<std::int64_t>(normal));
            const auto from = static_cast<std::int64_t>(std::min(scaled(about), 1e5));
            const auto low = static_cast<std::int64_t>(key.range.low);
            text << (choice == 0   ? low
                     : choice == 1 ? static_cast<std::int64_t>(std::min(key.range.high, key.range.low + 64))
                                   : from + (choice == 2 ? random.integer(0, 2) : 0));
            return text.str();
        }
        case KeyKind::number:
            text << (choice == 0 ? std::max(key.range.low, -10.0)
                                 : scaled(std::holds_alternative<double>(normal) ? std::get<double>(normal) : 1));
            return text.str();
        case KeyKind::vector:
            text << '[' << random.real(-6, 6) << ',' << random.real(-6, 6) << ',' << random.real(-6, 6) << ']';
            return text.str();
        case KeyKind::span: return random.coin() ? "data" : "[-0.5,1.5]";
        case KeyKind::numbers: return random.coin() ? "[0]" : "[0.5,1]";
        case KeyKind::text:
        case KeyKind::file:
        case KeyKind::folder: break;
    }
    return {};
}

struct RandomKey {
    const tessera::Key* key;
    bool other;  ///< concerns how the mesh is made, not which mesh
};

/// Every key but files and texts.
std::vector<RandomKey> all_keys() {
    std::vector<RandomKey> keys;
    Random random(0);
    for (const KeyTable& table : job_tables()) {
        const std::set<std::string> others{"", "timing", "check", "limits", "output"};
        for (const tessera::Key& key : table.keys)
            if (!any_value(random, key).empty())
                keys.push_back({&key, others.count(table.name) > 0});
    }
    return keys;
}

/// Mostly a job that meets all conditions, with some keys set at random.
std::string random_settings(Random& random, const std::vector<std::string>& map_files) {
    std::string text = random.chance(30) ? "hardware.design=modern " : "";
    text += "limits.triangles=100000 ";  // that of fitted heights, too
    const auto set = [&](const std::string& key, const auto& value) {
        std::ostringstream one;
        one.precision(17);
        one << key << '=' << value << ' ';
        text += one.str();
    };
    const auto pick = [&](std::initializer_list<const char*> values) { return std::string(random.one_of(values)); };
    const auto rarely = [&](unsigned percent, const std::string& key, const auto& value) {
        if (random.chance(percent))
            set(key, value);
    };
    if (random.chance(30))
        text += map_files[random.bits() % map_files.size()];
    else
        set("map.source", pick({"noise", "noise", "half_donut", "text", "ramp"}));
    set("map.seed", random.integer(0, 1000));
    set("map.width", random.integer(17, 50));
    set("map.height", random.integer(17, 50));
    rarely(30, "map.range", "data");
    rarely(20, "map.range", "[-0.25,0.5]");
    rarely(8, "map.heights", "fitted");
    set("mesh.source", random.chance(92) ? "lattice" : pick({"plane", "cylinder", "sphere"}));
    const std::int64_t spacing = std::int64_t{1} << random.integer(1, 6);
    set("mesh.spacing", spacing);
    for (const auto& [axis, side] : {std::pair{"map.address_u", "map.width"}, {"map.address_v", "map.height"}})
        if (random.chance(15)) {
            set(axis, "repeat");
            rarely(70, side, spacing * (16 / spacing + 1));
        }
    set("mesh.width", random.real(0.5, 20));
    set("mesh.depth", random.real(0.5, 20));
    set("displacement.scale", random.real(-1, 1));
    set("displacement.bias", random.real(-1, 1));
    set("hardware.height_test", random.chance(95) ? "rank" : pick({"summed_height", "curvature", "mipmap"}));
    if (random.chance(93) && text.find("=rank") != std::string::npos)
        set("hardware.triangulation", "greatest_rank");
    set("hardware.displacement_filter", pick({"nearest", "bilinear"}));
    rarely(5, "hardware.culling", "back");
    set("tests.normal", random.chance(12) ? "true" : "false");
    set("tests.normal_threshold", random.real(0.02, 0.3));
    set("tests.view", random.chance(8) ? "true" : "false");
    set("tests.view_threshold", random.real(0, 30));
    rarely(5, "tests.highlight", "true");
    rarely(4, "tests.summed_height", "false");
    rarely(50, "tests.tex_coord", "false");
    rarely(30, "tests.generation_limit", random.integer(0, 15));
    rarely(60, "tests.generation", "false");
    rarely(30, "formats.position_bits", random.integer(10, 31));
    set("formats.position_fraction", random.integer(0, 9));
    rarely(15, "formats.normal_bits", random.integer(16, 20));
    rarely(15, "formats.texture_fraction", random.integer(0, 12));
    rarely(40, "formats.displacement_bits", random.integer(4, 16));
    set("formats.rank_bits", pick({"0", "0", "6", "8", "16"}));
    set("formats.bound_bits", random.chance(96) ? random.integer(6, 16) : 0);
    set("tests.rank_threshold", random.chance(50) ? 1e6 : std::pow(10, random.real(-3, 1)));
    const bool pixels = random.chance(40);
    set("tests.bound_threshold", std::pow(10, pixels ? random.real(-1, 1.8) : random.real(-4, -0.3)));
    if (pixels) {
        set("tests.rank_view", pick({"per_point", "per_pixel"}));
        set("hardware.test_order", "cheap_first");
    }
    if (random.chance(70)) {
        std::ostringstream camera;
        camera << "camera.eye=[" << random.real(-8, 8) << ',' << random.real(-8, 8) << ',' << random.real(-2, 6)
               << "] camera.target=[" << random.real(-2, 2) << ',' << random.real(-2, 2) << ",0] camera.up=[0,0,1] "
               << "camera.field_of_view=" << random.real(10, 120) << " camera.near_plane=" << random.real(0.001, 0.5)
               << ' ';
        text += camera.str();
    }
    return text;
}

TEST_CASE("bound: of 300 jobs at random over all keys none exceeds it without a word, and with no word it holds") {
    Random random(41);
    const TestFolder folder;
    const std::vector<std::string> map_files = write_maps(folder, random);
    const std::vector<RandomKey> keys = all_keys();
    std::set<std::string> not_yet;
    for (const RandomKey& it : keys)
        not_yet.insert(it.key->name);
    int runs = 0, clean = 0, exceeded = 0, in_picture = 0, refused = 0, all_covered = 0, repeated = 0;
    for (int trial = 0; runs < 300; ++trial) {
        REQUIRE(trial < 1500);
        std::string settings = random_settings(random, map_files);
        // Those that no run has had first.
        const auto one_more = [&](bool other) {
            std::vector<const tessera::Key*> some, any;
            for (const RandomKey& it : keys)
                if (it.other == other)
                    (not_yet.count(it.key->name) > 0 ? some : any).push_back(it.key);
            const std::vector<const tessera::Key*>& from = some.empty() ? any : some;
            const tessera::Key& key = *from[random.bits() % from.size()];
            settings += key.name + '=' + any_value(random, key) + ' ';
        };
        for (int k = 0; k < 3; ++k)
            one_more(true);
        if (random.chance(40))
            one_more(false);
        INFO("trial " << trial << ": " << settings);
        std::optional<BoundRun> made;
        try {
            made.emplace(settings);
        } catch (const InputError&) {
            ++refused;
            continue;
        }
        const BoundRun& run = *made;
        if (!run.finished)
            continue;
        ++runs;
        std::istringstream all(settings);
        for (std::string setting; all >> setting;)
            not_yet.erase(setting.substr(0, setting.find('=')));
        INFO(run.words());
        if (!run.setup.bound_asked) {
            CHECK(run.remark().empty());
            CHECK_FALSE(run.result);
            continue;
        }
        const bool flat = run.job.mesh.source == MeshSource::lattice || run.job.mesh.source == MeshSource::plane;
        CHECK(run.result.has_value() == flat);
        if (!flat) {
            CHECK_FALSE(run.remark().empty());
            continue;
        }
        CHECK(run.result->verdict != BoundResult::Verdict::fault);
        const bool promised = run.remark().empty();
        CHECK(promised == run.result->promised);
        const double measured = run.result->deviation;
        const auto [largest, covered] = brute_force_deviation(run);
        if (covered && std::isfinite(largest))
            CHECK(measured == Approx(largest).epsilon(1e-5).margin(run.result->in_picture ? 1e-6 : 1e-9));
        all_covered += covered ? 1 : 0;
        const double deviation = std::max(measured, largest);
        CHECK(deviation <= measured * (1 + 1e-5) + 1e-6);
        const bool kept = deviation <= run.result->threshold * (1 + 1e-6);
        const bool said = run.result->text().rfind("holds: ", 0) != 0;
        CHECK((kept || said));
        if (!kept)
            CHECK_THAT(run.words(), Contains("(set ") || Contains("; set ") || Contains("lower camera.near_plane") ||
                                        Contains("values saturated"));
        clean += promised && kept ? 1 : 0;
        exceeded += kept ? 0 : 1;
        in_picture += promised && kept && run.result->in_picture ? 1 : 0;
        repeated += promised && kept &&
                            (run.job.map.address_u == Addressing::repeat || run.job.map.address_v == Addressing::repeat)
                        ? 1
                        : 0;
    }
    std::string missing;
    for (const std::string& name : not_yet)
        missing += name + ' ';
    INFO(clean << " clean, " << in_picture << " of them in the picture, " << repeated << " on a map that repeats, "
               << exceeded << " exceeded, " << refused << " refused, " << all_covered
               << " with every texel centre in a triangle");
    CHECK(missing.empty());
    CHECK(clean >= 75);
    CHECK(in_picture >= 25);
    CHECK(repeated >= 5);
    CHECK(exceeded >= 30);
    CHECK(all_covered >= 50);
}

}  // namespace
