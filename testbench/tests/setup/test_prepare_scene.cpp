#include "testbench/setup/prepare_scene.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "modules/datapath/registers.h"
#include "testbench/common/error.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/setup/setting_keys.h"
#include "testbench/tests/support/job_settings.h"

using namespace tessera;
using Catch::Contains;

namespace {

/// The content of a job's files, as another program would pass it.
Scene scene_of(const Inputs& inputs) {
    Scene scene;
    for (const BaseVertex& v : inputs.mesh.vertices)
        scene.vertices.push_back({{v.position.x, v.position.y, v.position.z}, {v.texture.x, v.texture.y}, {}});
    scene.triangles = inputs.mesh.triangles;
    scene.map_width = inputs.map.width;
    scene.map_height = inputs.map.height;
    scene.map = inputs.map.values;
    const Job& job = inputs.resolved.job;
    SceneSettings& settings = scene.settings;
    settings.displacement = job.displacement;
    settings.camera = job.camera;
    settings.tests = job.tests;
    settings.formats = job.formats;
    static_cast<SceneOptions&>(settings) = job.hardware;
    return scene;
}

Scene square() {
    Scene scene;
    scene.vertices = {
        {{0, 0, 0}, {0, 0}, {}}, {{1, 0, 0}, {1, 0}, {}}, {{1, 1, 0}, {1, 1}, {}}, {{0, 1, 0}, {0, 1}, {}}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.map_width = scene.map_height = 4;
    scene.map.assign(16, 0.5f);
    scene.settings.displacement.scale = 0.25;
    scene.settings.camera = {{0.5, -1.5, 1.5}, {0.5, 0.5, 0}, {0, 0, 1}, 36, 0.01, 640, 480};
    return scene;
}

std::vector<std::int64_t> register_values(const datapath::Registers& registers) {
    std::vector<std::int64_t> all;
    datapath::visit_registers(registers, [&](const datapath::Register&, const auto& values) {
        all.insert(all.end(), values.begin(), values.end());
    });
    return all;
}

std::vector<unsigned char> tables_of(const PreparedScene& scene) {
    std::vector<unsigned char> all;
    write_tables(scene, [&](std::uint64_t, const unsigned char* bytes, std::size_t count) {
        all.insert(all.end(), bytes, bytes + count);
    });
    return all;
}

/// Sets each number of one part of the settings below and above its declared range: each is refused, by its name.
template <typename Group>
class BeyondRanges {
  public:
    BeyondRanges(const char* part, Group& (*of)(SceneSettings&), int& tried) : part_(part), of_(of), tried_(tried) {}

    template <typename... Rest>
    void add(const char* name, std::int64_t Group::*member, const char*, const KeyRange& range, Rest...) const {
        for (const double value : {range.low - (range.or_zero ? range.low + 1 : 1), range.high + 1})
            refused(name, [&](Group& group) { group.*member = static_cast<std::int64_t>(value); });
    }
    template <typename... Rest>
    void add(const char* name, double Group::*member, const char*, const KeyRange& range, Rest...) const {
        add_double(
            name, [member](Group & group) -> auto& { return group.*member; }, "", range);
    }
    template <typename Member, typename... Rest>
    void add_double(const char* name, Member member, const char*, const KeyRange& range, Rest...) const {
        for (const double value : {range.low - 0.01 - std::abs(range.low), range.high + 0.01 + range.high})
            refused(name, [&](Group& group) { member(group) = value; });
    }
    template <typename... Rest>
    void add(const char* name, std::array<double, 3> Group::*member, const char*, const KeyRange& range,
             Rest...) const {
        for (const std::size_t k : {0u, 2u})
            for (const double value : {2 * range.low, 2 * range.high})
                refused(name, [&](Group& group) { (group.*member)[k] = value; });
    }
    template <typename Choice, typename Owner>
    void add(const char*, Choice Owner::*, const std::string&) const {}

  private:
    template <typename Spoil>
    void refused(const std::string& name, const Spoil& spoil) const {
        Scene scene = square();
        spoil(of_(scene.settings));
        ++tried_;
        INFO(part_ << name);
        CHECK_THROWS_WITH(prepare(scene), Contains("`" + (part_ + name) + "` = ") && Contains("must be "));
    }

    std::string part_;
    Group& (*of_)(SceneSettings&);
    int& tried_;
};

}  // namespace

TEST_CASE("every number of a scene's settings is held to its range") {
    int tried = 0;
    declare_scene_keys(BeyondRanges<SceneOptions>(
        "", [](SceneSettings& s) -> SceneOptions& { return s; }, tried));
    declare_displacement_keys(BeyondRanges<DisplacementSettings>(
        "displacement.", [](SceneSettings & s) -> auto& { return s.displacement; }, tried));
    declare_camera_keys(BeyondRanges<CameraSettings>(
        "camera.", [](SceneSettings & s) -> auto& { return s.camera; }, tried));
    declare_tests_keys(BeyondRanges<TestSettings>(
        "tests.", [](SceneSettings & s) -> auto& { return s.tests; }, tried));
    declare_formats_keys(BeyondRanges<FormatSettings>(
        "formats.", [](SceneSettings & s) -> auto& { return s.formats; }, tried));
    CHECK(tried > 70);
}

// The normals of the plane and the sphere are those that prepare() calculates.
TEST_CASE("a scene of plain structs gives the registers, tables and triangles of the job") {
    for (const MeshSource source : {MeshSource::plane, MeshSource::cylinder}) {
        Job job;
        job.mesh.source = source;
        job.map.width = job.map.height = 60;
        const Inputs inputs = load_inputs(job);
        const MachineSetup expected = make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
        Scene scene = scene_of(inputs);
        if (source == MeshSource::cylinder) {
            for (std::size_t k = 0; k < scene.vertices.size(); ++k) {
                const glm::dvec3& n = inputs.mesh.vertices[k].normal;
                scene.vertices[k].normal = {3 * n.x, 3 * n.y, 3 * n.z};
            }
        }
        const PreparedScene found = prepare(scene);
        CHECK(register_values(found.registers) == register_values(expected.registers));
        CHECK(found.map.codes == expected.map.codes);
        CHECK((tables_of(found) == tables_of(expected)));
        REQUIRE(found.base_triangles.size() == expected.base_triangles.size());
        unsigned different = 0;
        for (std::size_t k = 0; k < found.base_triangles.size(); ++k) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const datapath::Vertex &a = found.base_triangles[k].vertices[corner],
                                       &b = expected.base_triangles[k].vertices[corner];
                different += a.position == b.position && a.texture == b.texture && a.normal == b.normal &&
                                     a.tangent == b.tangent && a.handedness == b.handedness
                                 ? 0u
                                 : 1u;
            }
        }
        CHECK(different == 0);
    }
}

TEST_CASE("an invalid scene is refused with the value and a remedy, which works") {
    struct Case {
        const char* text;
        std::function<void(Scene&)> spoil;
        std::function<void(Scene&)> mend;  // as the text says
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Case cases[] = {
        {"`displacement.scale` is not set, or not a number: set it", [](Scene& s) { s.settings.displacement = {}; },
         [](Scene& s) { s.settings.displacement.scale = 1; }},
        {"`camera.eye` is not set, or not a number: set it", [](Scene& s) { s.settings.camera.eye = automatic_vector; },
         [](Scene& s) {
             s.settings.camera.eye = {0, -2, 1};
         }},
        {"`camera.near_plane` is not set, or not a number: set it",
         [](Scene& s) { s.settings.camera.near_plane = automatic; },
         [](Scene& s) { s.settings.camera.near_plane = 0.1; }},
        {"are the same point: set camera.target = [0.5, 0.6794494717703365, 1.5]",
         [](Scene& s) { s.settings.camera.target = s.settings.camera.eye; },
         [](Scene& s) {
             s.settings.camera.target = {0.5, 0.6794494717703365, 1.5};
         }},
        {"is parallel to the view direction [0.0, 2.0, -1.5] (camera.target - camera.eye): set camera.up = [1.0, 0.0, 0.0]",
         [](Scene& s) {
             s.settings.camera.up = {0, 2, -1.5};
         },
         [](Scene& s) {
             s.settings.camera.up = {1, 0, 0};
         }},
        {"`formats.position_bits` = 40: must be 8 to 32", [](Scene& s) { s.settings.formats.position_bits = 40; },
         [](Scene& s) { s.settings.formats.position_bits = 32; }},
        {"`formats.tex_coord_fraction` = 3: must be -1 to 2",
         [](Scene& s) { s.settings.formats.tex_coord_fraction = 3; },
         [](Scene& s) { s.settings.formats.tex_coord_fraction = -1; }},
        {"`formats.summed_height_bits` = 65: must be 0, or ",
         [](Scene& s) { s.settings.formats.summed_height_bits = 65; },
         [](Scene& s) { s.settings.formats.summed_height_bits = 0; }},
        {"`tests.normal_threshold` is not set, or not a number: set it",
         [](Scene& s) { s.settings.tests.normal_threshold = nan; },
         [](Scene& s) { s.settings.tests.normal_threshold = 0.1; }},
        {"`tests.generation_limit` = 9, but `formats.generation_bits` = 3 counts to 7: set tests.generation_limit = 7",
         [](Scene& s) {
             s.settings.formats.generation_bits = 3;
             s.settings.tests.generation_limit = 9;
         },
         [](Scene& s) { s.settings.tests.generation_limit = 7; }},
        {"or formats.generation_bits = 4",
         [](Scene& s) {
             s.settings.formats.generation_bits = 3;
             s.settings.tests.generation_limit = 9;
         },
         [](Scene& s) { s.settings.formats.generation_bits = 4; }},
        {"`light` has no direction: set one, such as [0, 0, 1]", [](Scene& s) { s.settings.light = {}; },
         [](Scene& s) {
             s.settings.light = {0, 0, 1};
         }},
        {"vertices[2] has a value that is not finite", [](Scene& s) { s.vertices[2].position[1] = nan; },
         [](Scene& s) { s.vertices[2].position[1] = 1; }},
        {"triangles[1] names vertex 4 of 4", [](Scene& s) { s.triangles[1][2] = 4; },
         [](Scene& s) { s.triangles[1][2] = 3; }},
        {"none of the 2 triangles has an area",
         [](Scene& s) {
             s.triangles = {{0, 1, 1}, {2, 2, 2}};
         },
         [](Scene& s) {
             s.triangles = {{0, 1, 2}};
         }},
        {"none of the 0 triangles has an area", [](Scene& s) { s.triangles.clear(); },
         [](Scene& s) {
             s.triangles = {{0, 1, 2}};
         }},
        {"a map of 0 x 4 texels: each side must be 1 to 4096 (formats.texture_integer)",
         [](Scene& s) { s.map_width = 0; },
         [](Scene& s) {
             s.map_width = 1;
             s.map.resize(4);
         }},
        {"the map has 16 values, but map_width x map_height = 20", [](Scene& s) { s.map_width = 5; },
         [](Scene& s) { s.map.resize(20); }},
        {"the map has a value that is not finite", [](Scene& s) { s.map[3] = static_cast<float>(nan); },
         [](Scene& s) { s.map[3] = 0; }},
        {"map_low > map_high", [](Scene& s) { s.map_low = 2; }, [](Scene& s) { s.map_low = 0; }},
        {"Transform's sums hold eyes",
         [](Scene& s) {
             s.settings.camera.eye = {0, 0, 1e12};
             s.settings.camera.up = {0, 1, 0};
         },
         [](Scene& s) {
             s.settings.camera.eye = {0, 0, 100};
         }},
    };
    CHECK_NOTHROW(prepare(square()));
    for (const Case& c : cases) {
        INFO(c.text);
        Scene scene = square();
        c.spoil(scene);
        CHECK_THROWS_WITH(prepare(scene), Contains(c.text));
        CHECK_THROWS_AS(prepare(scene), InputError);
        c.mend(scene);
        CHECK_NOTHROW(prepare(scene));
    }
}

TEST_CASE("triangles without area are left out of a scene, with a remark") {
    Scene scene = square();
    scene.triangles.push_back({0, 1, 1});
    const PreparedScene prepared = prepare(scene);
    CHECK(prepared.base_triangles.size() == 2);
    CHECK(prepared.remarks.back() == "triangles dropped because they have no area: 1");
}

TEST_CASE(
    "a Rank Table for a view has the radii of its displacement scale and format of distances, and bounds of any") {
    const auto tables = [](const std::string& settings) {
        const Job job = testing::with_settings({},
                                               "mesh.source=lattice mesh.spacing=16 map.width=48 map.height=48 "
                                               "hardware.height_test=rank formats.bound_bits=16 " +
                                                   settings);
        const Inputs inputs = load_inputs(job);
        return make_setup(inputs.resolved.job, inputs.mesh, inputs.map).rank_tables;
    };
    const std::string seen = "hardware.test_order=cheap_first tests.rank_view=per_point displacement.scale=";
    const RankTables on_surface = tables("displacement.scale=0.1"), low = tables(seen + "0.1"),
                     high = tables(seen + "0.4"),
                     coarse = tables(seen + "0.1 formats.position_bits=20 formats.position_fraction=8");
    CHECK(on_surface.bound == tables("displacement.scale=0.4").bound);
    CHECK(low.bound == high.bound);
    CHECK(low.radius != high.radius);
    CHECK(low.radius != coarse.radius);
}
