#include "testbench/machine/machine_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/bound_promise.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/prepare_model.h"
#include "testbench/setup/tables/fitted_heights.h"

namespace tessera {

namespace {

Design make_design(const Job& job) {
    Design design;
    static_cast<DesignOptions&>(design) = job.hardware;
    design.transport = job.mode == Mode::timed ? Transport::non_blocking : Transport::blocking;
    design.timing = job.timing;
    return design;
}

SceneSettings scene_settings(const Job& job) {
    SceneSettings settings;
    static_cast<SceneOptions&>(settings) = job.hardware;
    settings.displacement = job.displacement;
    settings.camera = job.camera;
    settings.tests = job.tests;
    settings.formats = job.formats;
    settings.address_u = job.map.address_u;
    settings.address_v = job.map.address_v;
    settings.families = job.hardware.work == Work::family;
    return settings;
}

/// Records where finished triangles lie on the map, and nothing else of them: a job without an end reaches its limit.
struct OnTheMap {
    struct Note {};
    std::vector<TextureTriangle> triangles;

    static Note begin(const datapath::Triangle&) { return {}; }
    static void decided(const datapath::TrianglePass&, const datapath::ChildIndices&, const Note&) {}
    static Note child(const std::array<std::uint8_t, 3>&) { return {}; }
    void finished(const datapath::Triangle& triangle, bool /*culled*/) {
        const auto& v = triangle.vertices;
        triangles.push_back({v[0].texture, v[1].texture, v[2].texture});
    }
};

/// Fits heights to the mesh that they give. A mesh beyond the job's limit is skipped, since its run stops there, and so is
/// a flat one.
void fit_heights_to_own_mesh(std::int64_t most_triangles, MachineSetup& setup) {
    const std::uint64_t most_edges = 6 * static_cast<std::uint64_t>(most_triangles);  // 3 a pass, at most 2 passes each
    const double height = std::abs(setup.height_per_code);
    bool ends = height > 0;
    const auto mesh_of = [&](const QuantisedMap& map) {
        setup.fitted_heights = map.codes;
        OnTheMap mesh;
        ends = ends && BareRecursion(setup).walk(mesh, most_edges) < most_edges;
        return std::move(mesh.triangles);
    };
    const QuantisedMap fitted = ends ? fit_heights(setup.map, mesh_of, setup.registers.formats,
                                                   {setup.texel_size[0] / height, setup.texel_size[1] / height})
                                     : setup.map;
    setup.fitted_heights.clear();
    if (ends)
        setup.fitted_heights = fitted.codes;
    if (ends ? fitted.codes == setup.map.codes : height == 0)
        setup.remarks.emplace_back(
            "map.heights = \"fitted\" has no effect: no other heights reduce this mesh's error without raising its "
            "largest distance from the surface; the map's own are used");
}

/// A sentence for the report if the map's values are all one, or so few of those that displacement.scale spans that the
/// surface is nearly flat (metres in 16 bits), or lie far beyond them and displace by more than the mesh's size; else
/// empty.
std::string unused_range_remark(const Job& job, const BaseMesh& mesh, const HeightMap& map) {
    constexpr double least_part = 1.0 / 8;
    const auto [low, high] = map.extremes();
    const double part = (high - low) / (std::max(high, map.span_high) - std::min(low, map.span_low));
    if (high == low)
        return fmt::format("every texel of the map holds {:.6g}: the surface has no relief", low * map.source_units);
    const bool in_model_units =
        map.source_units == 1 && job.map.range.kind == MapRange::Kind::full && job.displacement.scale == 1;
    if (job.map.range.kind == MapRange::Kind::data || in_model_units)
        return {};
    const MapDisplacement displacement = MapDisplacement::from(job.displacement, map);
    const double span = map.span_high - map.span_low;
    const auto [lowest, highest] = std::minmax({displacement.of(low), displacement.of(high)});
    const auto [nearest, farthest] = bounds_of(mesh.vertices);
    const glm::dvec3 sides = farthest - nearest;
    const double extent = std::max({sides.x, sides.y, sides.z});
    const bool far = (low < map.span_low - span || high > map.span_high + span) && std::max(-lowest, highest) > extent;
    if (part >= least_part && !far)
        return {};
    const std::string spans = fmt::format(
        "the {:.6g} to {:.6g} that displacement.scale spans{}: set map.range = \"data\" to "
        "span only values that occur",
        map.span_low * map.source_units, map.span_high * map.source_units,
        far ? fmt::format(", and displace by {:.6g} to {:.6g} model units", lowest, highest) : "");
    const std::string values =
        fmt::format("the map's values, {:.6g} to {:.6g}, ", low * map.source_units, high * map.source_units);
    if (low >= map.span_low && high <= map.span_high)
        return fmt::format("{}are {:.2g} % of {}", values, 100 * part, spans);
    return fmt::format("{}lie beyond {}", values, spans);
}

}  // namespace

MachineSetup make_setup(const Job& job, const BaseMesh& mesh, const HeightMap& map) {
    require_resolved(job, "make_setup");
    MachineSetup setup;
    const SceneSettings settings = scene_settings(job);
    static_cast<PreparedScene&>(setup) =
        prepare_model(settings, mesh, map, job.map.source == MapSource::file ? job.map.file : "map");
    setup.model_scale = {setup.scale, {setup.centre[0], setup.centre[1], setup.centre[2]}};
    setup.summed_height_bits_chosen = job.formats.summed_height_bits == 0;
    if (std::string remark = unused_range_remark(job, mesh, map);
        !remark.empty() && job.map.source != MapSource::constant)
        setup.remarks.insert(setup.remarks.begin(), std::move(remark));
    setup.design = make_design(job);
    setup.machines = static_cast<unsigned>(job.hardware.machines);
    if (job.map.heights == MapHeights::fitted)
        fit_heights_to_own_mesh(job.limits.triangles, setup);
    remark_on_bound(settings, mesh, setup);
    return setup;
}

}  // namespace tessera
