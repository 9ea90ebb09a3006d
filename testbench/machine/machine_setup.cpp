#include "testbench/machine/machine_setup.h"

#include <fmt/core.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "modules/datapath/registers.h"
#include "testbench/common/error.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/machine/setup/base_triangles.h"
#include "testbench/machine/setup/formats.h"
#include "testbench/machine/setup/light.h"
#include "testbench/machine/setup/table_layout.h"
#include "testbench/machine/setup/thresholds.h"
#include "testbench/machine/setup/view.h"

namespace tessera {

namespace {

datapath::AddressMode address_mode(Addressing mode) {
    return mode == Addressing::repeat ? datapath::AddressMode::repeat : datapath::AddressMode::clamp;
}

datapath::Triangulation triangulation_of(const Job::Hardware& hardware) {
    return hardware.triangulation == Triangulation::first    ? datapath::Triangulation::first
           : hardware.triangulation == Triangulation::second ? datapath::Triangulation::second
                                                             : datapath::Triangulation::shorter;
}

Design make_design(const Job& job) {
    Design design;
    design.transport = job.mode == Mode::timed ? Transport::non_blocking : Transport::blocking;
    design.timing = job.timing;
    design.queue.order = job.hardware.queue_order == QueueOrder::lifo ? TriangleOrder::lifo : TriangleOrder::fifo;
    design.queue.watermark = static_cast<std::size_t>(job.hardware.queue_watermark);
    design.queue.capacity = static_cast<std::size_t>(job.hardware.queue_capacity);
    design.queue.off_chip_triangles = static_cast<std::uint64_t>(job.hardware.off_chip_triangles);
    design.queue.overflow = job.hardware.queue_overflow == Overflow::spill   ? QueueOverflow::spill
                            : job.hardware.queue_overflow == Overflow::stall ? QueueOverflow::stall
                                                                             : QueueOverflow::error;
    design.tests_units = static_cast<unsigned>(job.hardware.tests_units);
    design.transform_pipelines = static_cast<unsigned>(job.hardware.transform_pipelines);
    design.work = job.hardware.work;
    design.test_order = job.hardware.test_order;
    design.edge_lanes = static_cast<unsigned>(job.hardware.edge_lanes);
    design.normal_tests = static_cast<unsigned>(job.hardware.normal_tests);
    design.direct_memory = job.hardware.direct_memory;
    return design;
}

/// Which keys to change where a value does not fit its register.
const char* remedy(std::string_view register_name) {
    if (register_name == "map.width" || register_name == "map.height")
        return "use a smaller map or raise formats.texture_integer";
    if (register_name == "tests.generation_limit")
        return "lower tests.generation_limit or raise formats.generation_bits";
    return "change the job's value or formats that it is made of";
}

/// That every value fits its register.
void check_registers(const datapath::Registers& registers) {
    datapath::visit_registers(registers, [](const datapath::Register& field, const auto& values) {
        for (const std::int64_t value : values) {
            if (!datapath::holds(field, value))
                throw InputError(fmt::format("the register {} has {} bits and cannot hold {}: {}", field.name,
                                             field.bits, value, remedy(field.name)));
        }
    });
}

void take_base_triangles(BaseTriangles&& made, MachineSetup& setup) {
    setup.base_triangles = std::move(made.triangles);
    setup.base_dropped = made.dropped;
    setup.texture_clamped = made.texture_clamped;
    setup.input_saturations.position = made.saturated_positions;
    setup.input_saturations.normal = made.saturated_directions;
    setup.remarks.insert(setup.remarks.end(), made.remarks.begin(), made.remarks.end());
}

}  // namespace

MachineSetup make_setup(const Job& job, const BaseMesh& mesh, const HeightMap& map) {
    require_resolved(job, "make_setup");
    MachineSetup setup;
    datapath::Registers& registers = setup.registers;
    datapath::Formats& formats = registers.formats;
    std::uint64_t& saturated = setup.input_saturations.registers;
    formats = make_formats(job.formats);
    setup.map =
        quantise_map(map, formats.displacement.bits, address_mode(job.map.address_u), address_mode(job.map.address_v));
    registers.map = setup.map.geometry;

    const DisplacementRange displacement = displacement_range(job.displacement, map);
    if (std::string remark = unused_range_remark(job.map.range, map); !remark.empty())
        setup.remarks.push_back(std::move(remark));
    setup.model_scale =
        fit_model(mesh, displacement, formats.position, job.map.source == MapSource::file ? job.map.file : "map");
    registers.displacement =
        make_displacement(displacement, setup.model_scale, setup.map.highest_code(), formats.position, saturated);
    setup.height_per_code =
        std::ldexp(static_cast<double>(registers.displacement.scale), -formats.position.fraction - setup.map.bits);
    setup.texel_size =
        glm::dvec2(mesh.texture_scale.mean_u / registers.map.width, mesh.texture_scale.mean_v / registers.map.height) *
        setup.model_scale.scale;

    take_base_triangles(round_base_triangles(mesh, setup.model_scale, formats, registers.map), setup);
    setup.largest_rectangle_sum =
        bound_rectangle_sum(setup.base_triangles, registers.map, formats, setup.map.highest_code());
    setup.summed_height_bits_chosen = job.formats.summed_height_bits == 0;
    formats.summed_height = datapath::Format::make_unsigned(
        summed_height_bits(job.formats.summed_height_bits, setup.largest_rectangle_sum), 0);
    lay_out_tables(registers);

    const ViewAxes view = view_axes(job.camera);
    registers.tests = make_tests(job.tests, formats);
    formats.highlight_tag = job.tests.highlight;
    formats.families = job.hardware.work == Work::family;
    formats.final_edges = job.hardware.final_edges && !formats.families;
    formats.codes = job.hardware.one_texel_from_map;
    if (job.tests.highlight &&
        !set_highlight_test(job.tests, towards_light(job.hardware), view.backward, formats, registers.tests, saturated))
        setup.remarks.emplace_back(
            "hardware.light shines straight towards the viewer: there is no highlight, and the Highlight "
            "Test never asks for a split");
    registers.transform = make_transform(job.camera, setup.model_scale, formats, saturated);
    formats.view_distance = view_distance_format(registers.transform, formats.position);
    registers.light = make_light(job.hardware, view, formats.normal, saturated);
    registers.triangulation = triangulation_of(job.hardware);
    registers.back_face_culling = job.hardware.culling == Culling::back;
    check_registers(registers);

    setup.design = make_design(job);
    setup.machines = static_cast<unsigned>(job.hardware.machines);
    return setup;
}

}  // namespace tessera
