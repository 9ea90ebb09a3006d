// The check of the host's set-up: it finds no error in the default job, and detects one wrong entry anywhere.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "modules/datapath/map_entry.h"
#include "modules/datapath/registers.h"
#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/conformance/setup_check.h"
#include "testbench/common/parallel.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/output/report/conformance_report.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/edited_mesh.h"
#include "testbench/tests/support/job_settings.h"

using namespace tessera;
using Catch::Contains;
using testing::SetupRun;

namespace {

struct Mistake {
    std::string name;  // as the check reports it
    std::function<void(MachineSetup&)> make;
};

/// One mistake for each register of the default job; numbers are off by one LSB.
std::vector<Mistake> register_mistakes() {
    using datapath::AddressMode;
    std::vector<Mistake> list;
    const auto add = [&](const std::string& name, auto member) {
        list.push_back({name, [member](MachineSetup& setup) { ++member(setup.registers); }});
        list.push_back({name, [member](MachineSetup& setup) { --member(setup.registers); }});
    };
    const auto turn = [&](const std::string& name, auto member) {
        list.push_back({name, [member](MachineSetup& setup) { member(setup.registers) = !member(setup.registers); }});
    };
    const auto format = [&](const std::string& name, datapath::Format datapath::Formats::*it) {
        add(
            "formats." + name + ".bits", [it](auto& r) -> auto& { return (r.formats.*it).bits; });
        add(
            "formats." + name + ".fraction", [it](auto& r) -> auto& { return (r.formats.*it).fraction; });
        add(
            "formats." + name + ".lowest", [it](auto& r) -> auto& { return (r.formats.*it).lowest; });
        add(
            "formats." + name + ".highest", [it](auto& r) -> auto& { return (r.formats.*it).highest; });
    };
    format("position", &datapath::Formats::position);
    format("normal", &datapath::Formats::normal);
    format("texture", &datapath::Formats::texture);
    format("displacement", &datapath::Formats::displacement);
    format("screen", &datapath::Formats::screen);
    add(
        "formats.generation_bits", [](auto& r) -> auto& { return r.formats.generation_bits; });
    add(
        "formats.view_distance", [](auto& r) -> auto& { return r.formats.view_distance.bits; });
    add(
        "formats.view_distance", [](auto& r) -> auto& { return r.formats.view_distance.fraction; });
    add(
        "formats.summed_height", [](auto& r) -> auto& { return r.formats.summed_height.bits; });
    add(
        "formats.summed_height.fraction", [](auto& r) -> auto& { return r.formats.summed_height.fraction; });
    turn(
        "formats.highlight_tag", [](auto& r) -> auto& { return r.formats.highlight_tag; });

    add(
        "map.width", [](auto& r) -> auto& { return r.map.width; });
    add(
        "map.height", [](auto& r) -> auto& { return r.map.height; });
    list.push_back({"map.address_u", [](MachineSetup& s) { s.registers.map.address_u = AddressMode::repeat; }});
    list.push_back({"map.address_v", [](MachineSetup& s) { s.registers.map.address_v = AddressMode::repeat; }});
    const auto table = [&](const std::string& name, datapath::TableLayout datapath::Registers::*it) {
        add(
            name + ".columns", [it](auto& r) -> auto& { return (r.*it).columns; });
        add(
            name + ".rows", [it](auto& r) -> auto& { return (r.*it).rows; });
        add(
            name + ".entry_bytes", [it](auto& r) -> auto& { return (r.*it).entry_bytes; });
    };
    table("displacement_map", &datapath::Registers::displacement_map);
    table("normal_map", &datapath::Registers::normal_map);
    table("summed_height_table", &datapath::Registers::height_table);
    list.push_back(
        {"overlap", [](MachineSetup& s) { s.registers.normal_map.base = s.registers.displacement_map.base + 2; }});

    turn(
        "tests.normal_test", [](auto& r) -> auto& { return r.tests.normal_test; });
    turn(
        "tests.summed_height_test", [](auto& r) -> auto& { return r.tests.summed_height_test; });
    turn(
        "tests.view_test", [](auto& r) -> auto& { return r.tests.view_test; });
    turn(
        "tests.tex_coord_test", [](auto& r) -> auto& { return r.tests.tex_coord_test; });
    turn(
        "tests.generation_test", [](auto& r) -> auto& { return r.tests.generation_test; });
    turn(
        "tests.highlight_test", [](auto& r) -> auto& { return r.tests.highlight_test; });
    add(
        "tests.normal_threshold", [](auto& r) -> auto& { return r.tests.normal_threshold; });
    add(
        "tests.summed_height_threshold", [](auto& r) -> auto& { return r.tests.height_thresholds[0]; });
    list.push_back({"tests.summed_height_unit",
                    [](MachineSetup& s) { s.registers.tests.summed_height_unit = datapath::SummedHeightUnit::area; }});
    add(
        "tests.view_threshold", [](auto& r) -> auto& { return r.tests.view_threshold; });
    add(
        "tests.generation_limit", [](auto& r) -> auto& { return r.tests.generation_limit; });
    add(
        "tests.highlight_cosine", [](auto& r) -> auto& { return r.tests.highlight_cosine; });
    add(
        "tests.highlight_normal_threshold", [](auto& r) -> auto& { return r.tests.highlight_normal_threshold; });

    add(
        "displacement.scale", [](auto& r) -> auto& { return r.displacement.scale; });
    add(
        "displacement.bias", [](auto& r) -> auto& { return r.displacement.bias; });

    for (std::size_t k = 0; k < 4; ++k) {
        // The fourth column has more bits than a double.
        const std::int64_t step = k < 3 ? 1 : 4096;
        const auto row = [&](const std::string& name, auto member) {
            for (const std::int64_t error : {step, -step})
                list.push_back({"transform." + name + "[" + std::to_string(k) + "]",
                                [=](MachineSetup& s) { (s.registers.transform.*member)[k] += error; }});
        };
        row("row_x", &datapath::TransformParameters::row_x);
        row("row_y", &datapath::TransformParameters::row_y);
        row("row_w", &datapath::TransformParameters::row_w);
    }
    add(
        "transform.", [](auto& r) -> auto& { return r.transform.exponent; });
    add(
        "transform.near_plane", [](auto& r) -> auto& { return r.transform.near_plane; });
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string index = "[" + std::to_string(k) + "]";
        for (std::size_t axis = 0; axis < 3; ++axis)
            add(
                "transform.normal_rows[" + std::to_string(axis) + "]" + index,
                [ axis, k ](auto& r) -> auto& { return r.transform.normal_rows[axis][k]; });
        add(
            "light.direction" + index, [k](auto& r) -> auto& { return r.light.direction[k]; });
        add(
            "tests.half_vector" + index, [k](auto& r) -> auto& { return r.tests.half_vector[k]; });
    }
    add(
        "light.ambient", [](auto& r) -> auto& { return r.light.ambient; });
    list.push_back(
        {"triangulation", [](MachineSetup& s) { s.registers.triangulation = datapath::Triangulation::first; }});
    turn(
        "back_face_culling", [](auto& r) -> auto& { return r.back_face_culling; });
    return list;
}

/// One mistake for each field of a vertex; numbers are off by one LSB.
std::vector<Mistake> vertex_mistakes() {
    std::vector<Mistake> list;
    const auto add = [&](const std::string& field, auto member) {
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{2}})
            list.push_back({"triangle 7, vertex " + std::to_string(k) + ", " + field,
                            [member, k](MachineSetup& s) { ++member(s.base_triangles[7].vertices[k]); }});
    };
    add(
        "position.x", [](auto& v) -> auto& { return v.position.x; });
    add(
        "position.y", [](auto& v) -> auto& { return v.position.y; });
    add(
        "position.z", [](auto& v) -> auto& { return v.position.z; });
    add(
        "normal.x", [](auto& v) -> auto& { return v.normal.x; });
    add(
        "normal.y", [](auto& v) -> auto& { return v.normal.y; });
    add(
        "normal.z", [](auto& v) -> auto& { return v.normal.z; });
    add(
        "tangent.x", [](auto& v) -> auto& { return v.tangent.x; });
    add(
        "tangent.y", [](auto& v) -> auto& { return v.tangent.y; });
    add(
        "tangent.z", [](auto& v) -> auto& { return v.tangent.z; });
    add(
        "texture.u", [](auto& v) -> auto& { return v.texture.u; });
    add(
        "texture.v", [](auto& v) -> auto& { return v.texture.v; });
    add(
        "handedness", [](auto& v) -> auto& { return v.handedness; });
    add(
        "generation", [](auto& v) -> auto& { return v.generation; });
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
        const std::string vertex = "triangle 7, vertex " + std::to_string(k) + ", ";
        list.push_back({vertex + "displaced_known",
                        [k](MachineSetup& s) { s.base_triangles[7].vertices[k].displaced_known = true; }});
        list.push_back({vertex + "screen_normal_known",
                        [k](MachineSetup& s) { s.base_triangles[7].vertices[k].screen_normal_known = true; }});
    }
    list.push_back({"triangle 7, split_by", [](MachineSetup& s) { ++s.base_triangles[7].split_by; }});
    list.push_back({"triangle 7, stopped_by", [](MachineSetup& s) { ++s.base_triangles[7].stopped_by; }});
    list.push_back({"triangle 7, finished", [](MachineSetup& s) { s.base_triangles[7].finished = true; }});
    list.push_back({"triangle 7, base", [](MachineSetup& s) { ++s.base_triangles[7].base; }});
    list.push_back({"triangle 17 of the mesh is missing", [](MachineSetup& s) { s.base_triangles.pop_back(); }});
    list.push_back({"19 base triangles", [](MachineSetup& s) { s.base_triangles.push_back(s.base_triangles.back()); }});
    return list;
}

using Socket = tlm_utils::simple_initiator_socket<Host>;

/// Adds to a byte of an entry by debug transport, as the host writes.
void add_to_entry(Socket& socket, const datapath::TableLayout& layout, std::uint32_t x, std::uint32_t y, unsigned which,
                  int add) {
    unsigned char byte = 0;
    tlm::tlm_generic_payload payload;
    payload.set_address(layout.address(x, y) + which);
    payload.set_data_ptr(&byte);
    payload.set_data_length(1);
    payload.set_streaming_width(1);
    payload.set_command(tlm::TLM_READ_COMMAND);
    REQUIRE(socket->transport_dbg(payload) == 1);
    byte = static_cast<unsigned char>(byte + add);
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    REQUIRE(socket->transport_dbg(payload) == 1);
}

}  // namespace

TEST_CASE("one wrong register, base vertex or table entry fails the default job") {
    SetupRun run{Job{}};
    const SetupResult right = run.check();
    INFO(right.first_wrong);
    REQUIRE(right.passed());
    REQUIRE(right.parts.size() == 5);
    CHECK(right.base_triangles.size() == 18);

    for (const auto& list : {register_mistakes(), vertex_mistakes()})
        for (const Mistake& mistake : list) {
            MachineSetup wrong = run.setup;
            mistake.make(wrong);
            run.require_noticed(wrong, mistake.name);
        }

    const datapath::Registers& registers = run.setup.registers;
    const auto every = [&](const std::string& name, Socket& socket, const datapath::TableLayout& layout,
                           const std::string& component = {}, unsigned which = 0) {
        for (const std::uint32_t x : {0U, layout.columns / 2, layout.columns - 1})
            for (const std::uint32_t y : {0U, layout.rows / 3, layout.rows - 1}) {
                add_to_entry(socket, layout, x, y, which, 1);
                const SetupResult result = run.check();
                CHECK(result.wrong() == 1);
                CHECK_THAT(result.first_wrong, Contains(fmt::format("{}: ({}, {}){}", name, x, y, component)));
                add_to_entry(socket, layout, x, y, which, -1);
            }
    };
    Host& host = run.simulation.host;
    every("displacement map", host.displacement_map, registers.displacement_map);
    every("normal map", host.normal_map, registers.normal_map, ".x", 0);  // 16 bits each
    every("normal map", host.normal_map, registers.normal_map, ".y", 2);
    every("normal map", host.normal_map, registers.normal_map, ".z", 4);
    every("summed height table", host.summed_height_table, registers.height_table);
    CHECK(run.check().passed());
}

namespace {

struct OtherTest {
    std::string name;
    std::string settings;
};

/// Changes the first value of a register by `by`.
void change(datapath::Registers& registers, const std::string& name, int by) {
    datapath::describe_registers(registers, [&](const datapath::Register& field, auto& value, auto&...) {
        using Value = std::decay_t<decltype(value)>;
        if (field.name == name)
            value = std::is_same_v<Value, bool> ? static_cast<Value>(!static_cast<bool>(value))
                                                : static_cast<Value>(static_cast<std::int64_t>(value) + by);
    });
}

std::vector<std::string> names_of(const datapath::Registers& registers) {
    std::vector<std::string> names;
    datapath::visit_registers(registers,
                              [&](const datapath::Register& field, const auto&) { names.push_back(field.name); });
    return names;
}

const testing::CaseTable other_tests(
    "one wrong register or table entry fails the job of a ",
    {OtherTest{"Curvature Test", "hardware.height_test=curvature map.width=60 map.height=60"},
     {"Mipmap Test", "hardware.height_test=mipmap tests.mipmap_filter=maximum map.width=60 map.height=37"},
     {"Rank Test",
      "hardware.height_test=rank mesh.source=lattice mesh.spacing=16 map.width=60 map.height=44 formats.bound_bits=8"},
     {"Rank Test as the viewer sees it",
      "hardware.height_test=rank mesh.source=lattice mesh.spacing=16 map.width=60 map.height=44 formats.bound_bits=8 "
      "hardware.test_order=cheap_first tests.rank_view=per_pixel"}},
    [](const OtherTest& row) {
        SetupRun run{testing::with_settings({}, row.settings)};
        const SetupResult right = run.check();
        INFO(right.first_wrong);
        REQUIRE(right.passed());
        REQUIRE(right.parts.size() == (row.name == "Mipmap Test" ? 5 : 6));
        const std::string table_name = functions_of(run.setup.registers.formats.height_test).table();
        const std::vector<std::string> others = names_of({});
        for (const int by : {1, -1}) {
            for (const std::string& name : names_of(run.setup.registers))
                if (std::find(others.begin(), others.end(), name) == others.end()) {
                    MachineSetup wrong = run.setup;
                    change(wrong.registers, name, by);
                    run.require_noticed(wrong, name);
                }
            for (const auto& [name, side] : {std::pair{".columns", &datapath::TableLayout::columns},
                                             {".rows", &datapath::TableLayout::rows},
                                             {".entry_bytes", &datapath::TableLayout::entry_bytes}}) {
                MachineSetup wrong = run.setup;
                wrong.registers.height_table.*side += static_cast<std::uint32_t>(by);
                run.require_noticed(wrong, table_name + name);
            }
        }
        const datapath::TableLayout& table = run.setup.registers.height_table;
        Socket& socket = run.simulation.host.summed_height_table;
        const std::string spoken = table_name.substr(0, table_name.find('_')) + " table: ";
        for (const std::uint32_t x : {0U, table.columns / 2, table.columns - 1})
            for (unsigned byte = 0; byte < table.entry_bytes; ++byte) {
                add_to_entry(socket, table, x, table.rows - 1, byte, 1);
                const SetupResult result = run.check();
                CHECK(result.wrong() >= 1);
                CHECK_THAT(result.first_wrong, Contains(spoken) && Contains(std::to_string(x)));
                add_to_entry(socket, table, x, table.rows - 1, byte, -1);
            }
        CHECK(run.check().passed());
    });

}  // namespace

TEST_CASE("one wrong fitted height fails its job") {
    Job job;
    job.map.heights = MapHeights::fitted;
    job.map.width = job.map.height = 60;
    SetupRun run{job};
    REQUIRE(run.check().passed());
    REQUIRE(run.setup.heights() != run.setup.map.codes);
    add_to_entry(run.simulation.host.displacement_map, run.setup.registers.displacement_map, 30, 30, 0, 1);
    CHECK_THAT(run.check().first_wrong, Contains("displacement map: (30, 30)"));
}

TEST_CASE("a fitted height that does not occur around its texel fails its job, although it is copied correctly") {
    Job job;
    job.map.heights = MapHeights::fitted;
    job.map.width = job.map.height = 60;
    SetupRun run{job};
    const auto set_to_own = [&](int more) {
        const std::size_t texel = 2 * 60 + 2;  // level ground
        MachineSetup other = run.setup;
        const int before = other.fitted_heights[texel];
        other.fitted_heights[texel] = static_cast<std::uint16_t>(other.map.codes[texel] + more);
        REQUIRE(before == other.map.codes[texel]);
        add_to_entry(run.simulation.host.displacement_map, run.setup.registers.displacement_map, 2, 2, 0, more);
        const GoldenJob golden(run.resolved, run.mesh, run.map, run.setup.model_scale, other);
        const SetupResult result = check_setup(run.setup, golden, run.simulation);
        add_to_entry(run.simulation.host.displacement_map, run.setup.registers.displacement_map, 2, 2, 0, -more);
        return result;
    };
    CHECK(set_to_own(0).passed());
    CHECK_THAT(set_to_own(1).first_wrong, Contains("fitted heights: (2, 2)"));
}

TEST_CASE("a wrong value is tried for every register of the default design") {
    std::set<std::string> tried;
    for (const Mistake& mistake : register_mistakes())
        tried.insert(mistake.name.substr(0, mistake.name.find('[')));
    const std::map<std::string, std::string> under{
        {"displacement_map.base", "overlap"},          {"normal_map.base", "overlap"},
        {"summed_height_table.base", "overlap"},       {"transform.row_x.offset", "transform.row_x"},
        {"transform.row_y.offset", "transform.row_y"}, {"transform.row_w.offset", "transform.row_w"},
        {"transform.exponent", "transform."},          {"transform.view_distance_shift", "formats.view_distance"}};
    datapath::Registers registers;
    registers.formats.highlight_tag = true;
    datapath::visit_registers(registers, [&](const datapath::Register& field, const auto&) {
        const auto other = under.find(field.name);
        CHECK(tried.count(other == under.end() ? field.name : other->second) == 1);
    });
}

namespace {

struct TexCoordRow {
    std::string name;
    MapFilter filter;
    std::int64_t asked, texture_fraction;
    int expected;
};

const testing::CaseTable tex_coord_fractions("operands of the Tex Coord Test, checked by golden: ",
                                             {TexCoordRow{"nearest, whole texels", MapFilter::nearest, -1, 12, 0},
                                              {"nearest, the job's half texels", MapFilter::nearest, 1, 12, 1},
                                              {"bilinear, half texels", MapFilter::bilinear, -1, 12, 1},
                                              {"bilinear, half texels, one bit", MapFilter::bilinear, -1, 1, 1},
                                              {"bilinear, whole texels, no bits", MapFilter::bilinear, -1, 0, 0},
                                              {"bilinear, the job's whole texels", MapFilter::bilinear, 0, 12, 0},
                                              {"bilinear, the job's quarter texels", MapFilter::bilinear, 2, 12, 2}},
                                             [](const TexCoordRow& row) {
                                                 Job job;
                                                 job.map.width = job.map.height = 20;
                                                 job.hardware.displacement_filter = row.filter;
                                                 job.formats.tex_coord_fraction = row.asked;
                                                 job.formats.texture_fraction = row.texture_fraction;
                                                 SetupRun run{job};
                                                 CHECK(run.check().passed());
                                                 int& fraction = run.setup.registers.formats.tex_coord_fraction;
                                                 CHECK(fraction == row.expected);
                                                 fraction = row.expected == 0 ? 1 : 0;
                                                 run.require_noticed(run.setup, "tex_coord_fraction");
                                             });

}  // namespace

TEST_CASE("the setup of a job with other formats, a bias, a Highlight Test and a repeating map passes") {
    Job job;
    job.mesh.source = MeshSource::sphere;
    job.map.source = MapSource::noise;
    job.map.width = 40;
    job.map.height = 24;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = -0.3;
    job.displacement.bias = 0.7;
    job.camera.eye = {0, -9, 2};
    job.tests.highlight = true;
    job.tests.summed_height_unit = SummedHeightUnit::area;
    job.tests.threshold("summed_height_threshold") = 0.1;
    job.tests.generation_limit = 2;
    job.formats.position_bits = 24;
    job.formats.position_fraction = 10;
    job.formats.normal_bits = 12;
    job.formats.normal_fraction = 10;
    job.formats.displacement_bits = 9;
    job.formats.summed_height_bits = 16;  // sums over the whole map wrap
    job.formats.texture_fraction = 5;
    job.hardware.culling = Culling::back;
    job.hardware.triangulation = Triangulation::second;
    SetupRun run{job};
    const SetupResult result = run.check();
    INFO(result.first_wrong);
    CHECK(result.passed());

    MachineSetup wrong = run.setup;
    ++wrong.registers.tests.highlight_cosine;
    run.require_noticed(wrong, "tests.highlight_cosine");
    wrong = run.setup;
    --wrong.registers.tests.half_vector[1];
    run.require_noticed(wrong, "tests.half_vector[1]");
    wrong = run.setup;
    ++wrong.registers.tests.highlight_normal_threshold;
    run.require_noticed(wrong, "tests.highlight_normal_threshold");
    // The host may shift a triangle by whole periods, but not a single corner.
    wrong = run.setup;
    const std::uint32_t period = 40U << 5;
    for (datapath::Vertex& vertex : wrong.base_triangles[3].vertices)
        vertex.texture.u += period;
    CHECK(check_setup(wrong, run.golden, run.simulation).passed());
    wrong.base_triangles[3].vertices[1].texture.u -= period;
    run.require_noticed(wrong, "triangle 3, vertex 1, texture.u");
}

TEST_CASE("a base triangle is left out only if it collapses in the formats") {
    Job job;
    job.formats.position_bits = 10;
    job.formats.position_fraction = 4;
    job.formats.texture_fraction = 0;
    job.tests.generation_limit = 1;
    BaseMesh mesh = load_mesh(job);
    // A sliver, much narrower than an LSB, on the third triangle's edge.
    const auto corners = mesh.triangles[2];
    BaseVertex moved = mesh.vertices[corners[0]];
    moved.position.x += 1e-9;
    moved.texture.x += 1e-9;
    mesh.vertices.push_back(moved);
    const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    mesh.triangles.insert(mesh.triangles.begin() + 3, {corners[0], last, corners[1]});
    SetupRun run{job, mesh, load_map(job)};
    const SetupResult result = run.check();
    INFO(result.first_wrong);
    CHECK(result.passed());
    REQUIRE(result.base_triangles.size() == 18);
    CHECK(result.base_triangles[2] == 2);
    CHECK(result.base_triangles[3] == 4);
    CHECK(received_triangles(run.setup, run.golden) == result.base_triangles);
}

TEST_CASE("a model scale that is not a power of two, or is too large, is reported") {
    SetupRun run{Job{}};
    ModelScale three = run.setup.model_scale;
    three.scale *= 3;
    CHECK_THAT(check_setup(run.setup, GoldenJob(run.resolved, run.mesh, run.map, three), run.simulation).first_wrong,
               Contains("not a power of two"));
    ModelScale large = run.setup.model_scale;
    large.scale *= 16;
    const SetupResult result =
        check_setup(run.setup, GoldenJob(run.resolved, run.mesh, run.map, large), run.simulation);
    CHECK_THAT(result.first_wrong, Contains("a position"));
}

TEST_CASE("the golden run is judged by its triangles, the distance of the surfaces and its bound") {
    Job job;
    job.tests.generation_limit = 4;
    job.displacement.scale = 0.5;
    job.displacement.bias = -0.2;
    SetupRun run{job};
    const SetupResult checked = run.check();
    const auto compare = [&](const EmittedMesh& mesh, double allowed) {
        return GoldenRun(run.golden, checked.base_triangles).compare(run.setup, mesh, allowed);
    };
    EmittedMesh mesh = run.simulation.monitor.mesh;
    const EndToEndResult right = compare(mesh, 1);
    CHECK(right.passed());
    CHECK(right.rms_model() < 1e-3);
    // Heights from -0.2 to 0.3, exact normals, four generations: (4 / 2 + 2) LSB of the position.
    REQUIRE(right.golden_largest_generation == 4);
    const double rounding = std::sqrt(3.0) * 4 * std::ldexp(1.0, -16) / run.setup.model_scale.scale;
    CHECK(right.allowed.triangles == 1);
    CHECK(right.allowed.rounding == Approx(rounding));
    CHECK(right.allowed.displacement == Approx(0.5));
    CHECK(right.farther() < 0.1);

    std::vector<double> told;
    GoldenRun(run.golden, checked.base_triangles).compare(run.setup, mesh, 1, [&](double part) {
        told.push_back(part);
    });
    CHECK(told == std::vector<double>{0.5, 1});

    CHECK(right.allowed_rms_model() == Approx(rounding + std::sqrt(right.farther() / 100) * 0.5));

    Checks checks;
    const auto failed = [&](const EndToEndResult& result) {
        checks.end_to_end = result;
        CHECK_FALSE(checks.passed());
        CHECK_THAT(report_text(checks, {}), Contains("FAILED: end_to_end\n"));
        return !result.passed();
    };
    CHECK(failed(compare(first_of(mesh, mesh.triangles.size() * 97 / 100), 1)));

    // Lifted by 10 LSB, of which rounding explains 6.9; on slopes the distance is less.
    const EmittedMesh lifted = changed(mesh, [](EmittedTriangle& triangle) {
        for (auto& corner : triangle.corners)
            corner.displaced.z += 10;
    });
    const EndToEndResult off = compare(lifted, 1);
    CHECK(off.more_triangles() == right.more_triangles());
    CHECK(off.farther() > 50);
    CHECK(off.rms_model() < 1e-3);
    CHECK(failed(off));

    // A few triangles, farther away than any displacement puts them.
    std::vector<EmittedTriangle> thrown = list_of(mesh);
    for (std::size_t k = 0; k < thrown.size(); k += 400)
        thrown[k].corners[0].displaced.z += 6 * run.setup.registers.displacement.scale;
    const EndToEndResult spikes = compare({thrown}, 1);
    CHECK(spikes.farther() < 1);
    CHECK(failed(spikes));

    // The mesh's size limits golden's run; one stopped early is repeated up to there, on any number of threads.
    mesh = first_of(mesh, 10);
    const EndToEndResult stopped = compare(mesh, 1000);
    CHECK(stopped.golden_triangles < 1040);
    for (const std::size_t threads : {1U, 2U})
        for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{100}, UINT64_MAX}) {
            const OnThreads on(threads);
            GoldenRun golden_run(run.golden, checked.base_triangles, most);
            const EndToEndResult again = golden_run.compare(run.setup, mesh, 1000);
            CHECK(again.golden_triangles == stopped.golden_triangles);
            CHECK(again.golden_edges == stopped.golden_edges);
            CHECK(again.golden_largest_generation == stopped.golden_largest_generation);
            CHECK(again.bound_hit);
            GoldenRun whole(run.golden, checked.base_triangles, most);
            const EndToEndResult same = whole.compare(run.setup, run.simulation.monitor.mesh, 1);
            CHECK(same.golden_edges == right.golden_edges);
            CHECK(same.rms_model() == right.rms_model());
        }
    CHECK(stopped.bound_hit);
    CHECK(failed(stopped));
    CHECK_THAT(report_text(checks, {}), Contains("golden's run was stopped at 1040 triangles"));
}

TEST_CASE("a base triangle's periods are known where a period is one LSB") {
    SetupRun run{testing::with_settings({},
                                        "map.source=noise map.width=1 map.height=1 map.address_u=repeat "
                                        "map.address_v=repeat formats.texture_fraction=0 mesh.columns=4 mesh.rows=4")};
    const SetupResult result = run.check();
    INFO(result.first_wrong);
    CHECK(result.passed());
}
