#include "testbench/compare/bound_check.h"

#include <fmt/format.h>

#include <cmath>

#include "modules/datapath/format.h"

namespace tessera {

namespace {

/// Measures meshes against the threshold.
class Meter {
  public:
    Meter(const Job& job, const BaseMesh& base, const HeightMap& map, const HeightField& field)
        : base_(base),
          displacement_(DisplacementOf::from(job, map)),
          field_(field),
          view_(job.camera),
          in_picture_(job.tests.rank_view != RankView::none),
          full_(std::abs(displacement_.scale * (map.range_high - map.range_low))) {}

    VerticalError error(const HeightMap& map, const RecordedMesh& mesh) const {
        return measure_vertical_error(field_, base_, map, displacement_, mesh, in_picture_ ? &view_ : nullptr);
    }
    double deviation(const VerticalError& error) const {
        if (in_picture_)
            return error.max_pixels;
        return full_ > 0 ? error.max / full_ : 0;
    }

    /// The mesh with every vertex where its texture coordinate and the code under it place it.
    RecordedMesh unrounded(const HeightMap& coded, RecordedMesh mesh) const {
        const glm::dvec3 across = glm::cross(field_.u, field_.v);
        const double area = glm::dot(across, across);
        const glm::dvec3 along_u = glm::cross(field_.v, across) / area, along_v = glm::cross(across, field_.u) / area;
        for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
            const glm::dvec2 texel = mesh.textures[k] * glm::dvec2(coded.width, coded.height);
            const auto index = [](double at, int size, Addressing mode) {
                return static_cast<int>(addressed(static_cast<std::int64_t>(std::floor(at)), size, mode));
            };
            const glm::dvec2 away = texel - field_.texel_origin;
            const double value = coded.at(index(texel.x, coded.width, displacement_.address_u),
                                          index(texel.y, coded.height, displacement_.address_v));
            mesh.positions[k] =
                field_.origin + away.x * along_u + away.y * along_v + displacement_.of(value) * field_.normal;
        }
        return mesh;
    }

  private:
    const BaseMesh& base_;
    DisplacementOf displacement_;
    const HeightField& field_;
    ErrorView view_;
    bool in_picture_;
    double full_;  // model units
};

/// The map as the machine's codes give it.
HeightMap coded_map(const HeightMap& map, const MachineSetup& setup) {
    HeightMap coded = map;
    const double step = (map.range_high - map.range_low) / setup.map.highest_code();
    for (std::size_t k = 0; k < coded.values.size(); ++k)
        coded.values[k] = static_cast<float>(map.range_low + step * setup.map.codes[k]);
    return coded;
}

double rounded_up(double value) {
    const double step = std::pow(10, std::floor(std::log10(value)) - 2);
    return std::ceil(value / step) * step;
}

std::string larger_threshold(double deviation) {
    return fmt::format("tests.bound_threshold = {:.4g}", rounded_up(deviation));
}

/// As many bits as bring `excess` below `room`; if there are not as many, a larger threshold.
std::string more_bits(const char* key, std::int64_t bits, int most, double excess, double room, double deviation) {
    const double more = room > 0 ? std::ceil(std::log2(excess / room)) + 1 : most;
    if (static_cast<double>(bits) + std::max(more, 1.0) > most)
        return larger_threshold(deviation);
    return fmt::format("{} = {}", key, bits + static_cast<std::int64_t>(std::max(more, 1.0)));
}

}  // namespace

std::string BoundResult::text() const {
    const std::string found =
        fmt::format("{} texel centres{} are at most {:.4g} {} from the mesh, {}tests.bound_threshold = {}", points,
                    in_picture ? " in the picture" : "", deviation, in_picture ? "pixels" : "of full scale",
                    threshold > 0 ? fmt::format("{:.1f} % of ", 100 * deviation / threshold) : "", threshold);
    const std::string worst = fmt::format("{}, worst at texel ({}, {})", found, worst_texel.x, worst_texel.y);
    switch (verdict) {
        case Verdict::nothing:
            return in_picture ? "no texel centre of the mesh is in the picture: set camera.eye = \"auto\" and "
                                "camera.target = \"auto\""
                              : "no texel centre is on the mesh";
        case Verdict::holds: return (promised ? "holds: " : "kept here, but not guaranteed (see the note): ") + found;
        case Verdict::not_promised: return "exceeded, and not guaranteed (see the note): " + worst;
        case Verdict::positions: return fmt::format("exceeded by the rounding of positions: {}; set {}", worst, remedy);
        case Verdict::heights:
            return fmt::format("exceeded by the rounding of heights to codes: {}; set {}", worst, remedy);
        case Verdict::near_plane:
            return fmt::format("the near plane is between a point of the map and the mesh: {}; lower camera.near_plane",
                               worst);
        case Verdict::saturated: return "exceeded, and values saturated (see the warning): " + worst;
        case Verdict::fault: break;
    }
    return worst + ", though every condition is met: a fault of tessera";
}

std::optional<BoundResult> check_bound(const Job& job, const BaseMesh& base, const HeightMap& map,
                                       const MachineSetup& setup, const RecordedMesh& mesh, bool saturated) {
    std::string why;
    if (!setup.bound_asked)
        return {};
    const std::optional<HeightField> field = find_height_field(base, map, DisplacementOf::from(job, map), why);
    if (!field)
        return {};
    using Verdict = BoundResult::Verdict;
    using Limits = datapath::FormatLimits;
    constexpr double above_rounding = 1 + 1e-9;
    const Meter meter(job, base, map, *field);
    const VerticalError error = meter.error(map, mesh);
    BoundResult result;
    result.promised = setup.bound_promised;
    result.in_picture = job.tests.rank_view != RankView::none;
    result.threshold = job.tests.threshold("bound_threshold");
    result.deviation = meter.deviation(error);
    result.points = result.in_picture ? error.seen : error.covered;
    result.worst_texel = error.worst_texel;
    if (result.points == 0) {
        result.verdict = Verdict::nothing;
        return result;
    }
    const double allowed = result.threshold * above_rounding;
    if (result.deviation <= allowed)
        return result;
    if (!result.promised) {
        result.verdict = Verdict::not_promised;
        return result;
    }
    // Without rounding a threshold of zero is met but for that of double precision, far below that of positions.
    const double met = allowed + 1e-6 * result.deviation;
    const HeightMap coded = coded_map(map, setup);
    const RecordedMesh unrounded = meter.unrounded(coded, mesh);
    const double ideal = meter.deviation(meter.error(map, unrounded));
    if (ideal <= met) {
        result.verdict = Verdict::positions;
        result.remedy = more_bits("formats.position_bits", job.formats.position_bits, Limits::position_bits.most,
                                  result.deviation - ideal, result.threshold - ideal, result.deviation);
    } else if (const double of_codes = meter.deviation(meter.error(coded, unrounded)); of_codes <= met) {
        result.verdict = Verdict::heights;
        result.remedy =
            more_bits("formats.displacement_bits", job.formats.displacement_bits, Limits::displacement_bits.most,
                      result.deviation - of_codes, result.threshold - of_codes, result.deviation);
    } else if (std::isinf(result.deviation)) {
        result.verdict = Verdict::near_plane;
    } else {
        result.verdict = saturated ? Verdict::saturated : Verdict::fault;
    }
    return result;
}

}  // namespace tessera
