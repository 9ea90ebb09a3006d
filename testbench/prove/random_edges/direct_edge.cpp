#include "testbench/prove/random_edges/direct_edge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace tessera {

namespace {

using datapath::AddressMode, datapath::Direction, datapath::Format, datapath::Vertex;

__extension__ using Wide = __int128;

std::int64_t divide_down(std::int64_t value, std::int64_t by) {
    const std::int64_t quotient = value / by;
    return value % by < 0 ? quotient - 1 : quotient;
}

/// value / 2^places rounded to nearest, ties upwards.
std::int64_t nearest(std::int64_t value, int places) {
    const std::int64_t unit = std::int64_t{1} << places;
    std::int64_t rest = value % unit, quotient = value / unit;
    if (rest < 0) {
        rest += unit;
        --quotient;
    }
    return 2 * rest >= unit ? quotient + 1 : quotient;
}

std::int64_t half_of_both(std::int64_t a, std::int64_t b) {
    return divide_down(a + b, 2);
}

std::array<std::int64_t, 3> mean(const Direction& a, const Direction& b) {
    return {half_of_both(a.x, b.x), half_of_both(a.y, b.y), half_of_both(a.z, b.z)};
}

std::uint64_t magnitude(std::int64_t value) {
    return static_cast<std::uint64_t>(value < 0 ? -value : value);
}

/// Error of the doubles here, added to a documented bound.
constexpr double slack = 1e-6;

}  // namespace

DirectMap::DirectMap(const datapath::MapGeometry& geometry, std::vector<std::uint32_t> codes,
                     std::vector<Direction> normals)
    : geometry_(geometry), codes_(std::move(codes)), normals_(std::move(normals)) {
    const std::size_t columns = 2 * std::size_t{geometry.width} + 1, rows = 2 * std::size_t{geometry.height} + 1;
    sums_.assign(columns * rows, 0);
    for (std::size_t y = 1; y < rows; ++y)
        for (std::size_t x = 1; x < columns; ++x)
            sums_[y * columns + x] = sums_[(y - 1) * columns + x] + sums_[y * columns + x - 1] -
                                     sums_[(y - 1) * columns + x - 1] +
                                     codes_[(y - 1) % geometry.height * geometry.width + (x - 1) % geometry.width];
}

std::size_t DirectMap::index(std::int64_t x, std::int64_t y) const {
    const auto inside = [](std::int64_t at, std::int64_t size, AddressMode mode) {
        return static_cast<std::size_t>(mode == AddressMode::repeat ? at - divide_down(at, size) * size
                                                                    : std::clamp<std::int64_t>(at, 0, size - 1));
    };
    return inside(y, geometry_.height, geometry_.address_v) * geometry_.width +
           inside(x, geometry_.width, geometry_.address_u);
}

std::uint64_t DirectMap::sum(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) const {
    const std::size_t columns = 2 * std::size_t{geometry_.width} + 1;
    const auto entry = [&](std::size_t column, std::size_t row) { return sums_[row * columns + column]; };
    return entry(x + width, y + height) - entry(x, y + height) - entry(x + width, y) + entry(x, y);
}

DirectEdge::Texel DirectEdge::texel(const datapath::TexCoord& t) const {
    const std::uint32_t unit = std::uint32_t{1} << registers_.formats.texture.fraction;
    return {t.u / unit, t.v / unit};
}

/// Between texels: a weighted sum of four values; the weights are multiples of a quarter of the square of t's unit.
template <class Value>
std::int64_t DirectEdge::read(const datapath::TexCoord& t, int fraction, Value value) const {
    const datapath::Formats& formats = registers_.formats;
    if (formats.filter == datapath::MapFilter::nearest) {
        const Texel at = texel(t);
        return value(at.x, at.y);
    }
    const std::int64_t whole = std::int64_t{2} << formats.texture.fraction;  // a texel, in halves of t's unit
    const std::int64_t u = 2 * std::int64_t{t.u} - whole / 2, v = 2 * std::int64_t{t.v} - whole / 2;
    const std::int64_t x = divide_down(u, whole), y = divide_down(v, whole);
    std::int64_t sum = 0;
    for (std::int64_t right = 0; right < 2; ++right)
        for (std::int64_t up = 0; up < 2; ++up)
            sum += (whole - std::abs(u - (x + right) * whole)) * (whole - std::abs(v - (y + up) * whole)) *
                   value(x + right, y + up);
    return nearest(sum, 2 * formats.texture.fraction + 2 - fraction);
}

/// A tenth of an LSB in a format of 18 bits is a million times a double's rounding error.
bool DirectEdge::is_unit(const std::array<std::int64_t, 3>& vector, const Direction& unit) const {
    const Format& format = registers_.formats.normal;
    const double x = static_cast<double>(vector[0]), y = static_cast<double>(vector[1]),
                 z = static_cast<double>(vector[2]);
    const double square = x * x + y * y + z * z;
    if (square == 0)
        return unit == Direction{};
    const double scale = std::ldexp(1.0, format.fraction) / std::sqrt(square);
    const double bound = 0.5 + std::ldexp(1.0, format.fraction - 28) + slack;
    const auto right = [&](double component, std::int32_t found) {
        return std::fabs(component * scale - found) <= bound;
    };
    return right(x, unit.x) && right(y, unit.y) && right(z, unit.z);
}

bool DirectEdge::is_bumped(const Vertex& v) const {
    const int fraction = registers_.formats.normal.fraction;
    const Direction &n = v.normal, &t = v.tangent;
    const auto cross = [&](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        return v.handedness * nearest(a * b - c * d, fraction);
    };
    const std::int64_t bx = cross(n.y, t.z, n.z, t.y), by = cross(n.z, t.x, n.x, t.z), bz = cross(n.x, t.y, n.y, t.x);
    const auto component = [&](std::int32_t Direction::*which) {
        return read(v.texture, 0, [&](auto x, auto y) { return std::int64_t{map_.normal(x, y).*which}; });
    };
    const std::int64_t mx = component(&Direction::x), my = component(&Direction::y), mz = component(&Direction::z);
    const auto combined = [&](std::int64_t tangent, std::int64_t bitangent, std::int64_t normal) {
        return nearest(mx * tangent + my * bitangent + mz * normal, std::max(0, fraction - 2));
    };
    return is_unit({combined(t.x, bx, n.x), combined(t.y, by, n.y), combined(t.z, bz, n.z)}, v.displaced_normal);
}

bool DirectEdge::is_displaced(const Vertex& v) const {
    const datapath::Formats& formats = registers_.formats;
    // An interpolated code is exact or keeps eight fraction bits.
    const int fraction =
        formats.filter == datapath::MapFilter::nearest ? 0 : std::min(8, 2 * std::max(1, formats.texture.fraction));
    const std::int64_t code = read(v.texture, fraction, [&](auto x, auto y) { return std::int64_t{map_.code(x, y)}; });
    const std::int64_t height = nearest(registers_.displacement.scale * code, formats.displacement.bits + fraction) +
                                registers_.displacement.bias;
    const auto right = [&](std::int64_t base, std::int64_t normal, std::int64_t found) {
        return found == std::clamp(base + nearest(height * normal, formats.normal.fraction), formats.position.lowest,
                                   formats.position.highest);
    };
    return right(v.position.x, v.normal.x, v.displaced.x) && right(v.position.y, v.normal.y, v.displaced.y) &&
           right(v.position.z, v.normal.z, v.displaced.z);
}

bool DirectEdge::is_on_screen(const Vertex& v) const {
    const datapath::TransformParameters& parameters = registers_.transform;
    const datapath::Formats& formats = registers_.formats;
    const auto row = [&](const std::array<std::int64_t, 4>& r) {
        return static_cast<std::int64_t>(Wide{r[0]} * v.displaced.x + Wide{r[1]} * v.displaced.y +
                                         Wide{r[2]} * v.displaced.z + r[3]);
    };
    const std::int64_t w = row(parameters.row_w);
    const int w_places =
        datapath::TransformParameters::matrix_fraction + formats.position.fraction - formats.view_distance.fraction;
    if (v.screen.w != std::clamp(nearest(w, w_places), formats.view_distance.lowest, formats.view_distance.highest))
        return false;
    if (v.screen.in_front != (w > parameters.near_plane))
        return false;
    if (!v.screen.in_front)
        return v.screen.x == 0 && v.screen.y == 0;
    const auto right = [&](const std::array<std::int64_t, 4>& r, std::int32_t found) {
        const double exact = std::ldexp(static_cast<double>(row(r)) / static_cast<double>(w),
                                        parameters.exponent + formats.screen.fraction);
        const double held =
            std::clamp(exact, static_cast<double>(formats.screen.lowest), static_cast<double>(formats.screen.highest));
        return std::fabs(held - found) <= 0.5 + std::fabs(held) * 0x1p-28 + slack;
    };
    return right(parameters.row_x, v.screen.x) && right(parameters.row_y, v.screen.y);
}

const char* DirectEdge::fault_of_vertex(const Vertex& i, const Vertex& j, const Vertex& inserted) const {
    const auto middle = [](std::int64_t a, std::int64_t b, std::int64_t found) { return found == half_of_both(a, b); };
    if (!middle(i.position.x, j.position.x, inserted.position.x) ||
        !middle(i.position.y, j.position.y, inserted.position.y) ||
        !middle(i.position.z, j.position.z, inserted.position.z))
        return "P";
    if (!middle(i.texture.u, j.texture.u, inserted.texture.u) || !middle(i.texture.v, j.texture.v, inserted.texture.v))
        return "t";
    if (!is_unit(mean(i.normal, j.normal), inserted.normal))
        return "N";
    if (!is_unit(mean(i.tangent, j.tangent), inserted.tangent))
        return "T";
    if (inserted.handedness != (i.handedness == 1 && j.handedness == 1 ? 1 : -1))
        return "handedness";
    if (inserted.generation != std::min(255, std::max<int>(i.generation, j.generation) + 1))
        return "generation";
    if (!is_displaced(inserted))
        return "P'";
    if (!is_bumped(inserted))
        return "N'";
    return is_on_screen(inserted) ? nullptr : "P's";
}

std::uint32_t DirectEdge::first_texel(std::uint32_t coordinate, std::uint32_t extent, std::uint32_t size,
                                      AddressMode mode) const {
    const std::int64_t first = std::int64_t{coordinate} - extent / 2;
    if (mode == AddressMode::clamp)
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(first, 0, std::int64_t{size} - extent));
    return static_cast<std::uint32_t>(((first % size) + size) % size);
}

EdgeMeasures DirectEdge::measure(const Vertex& i, const Vertex& j, const Vertex& inserted) const {
    EdgeMeasures result;
    const auto cosine = [&](const Direction& n) {
        const auto& h = registers_.tests.half_vector;
        return std::int64_t{n.x} * h[0] + std::int64_t{n.y} * h[1] + std::int64_t{n.z} * h[2];
    };
    result.cosine = cosine(inserted.displaced_normal);
    for (const Vertex* end : {&i, &j}) {
        const Direction &n = end->displaced_normal, &m = inserted.displaced_normal;
        result.normal = std::max({result.normal, magnitude(std::int64_t{n.x} - m.x), magnitude(std::int64_t{n.y} - m.y),
                                  magnitude(std::int64_t{n.z} - m.z)});
        result.cosine = std::max(result.cosine, cosine(n));
    }
    result.length = magnitude(std::int64_t{i.screen.x} - j.screen.x) + magnitude(std::int64_t{i.screen.y} - j.screen.y);

    const datapath::MapGeometry& map = registers_.map;
    const std::uint64_t unit = std::uint64_t{1} << registers_.formats.texture.fraction;
    const auto extent = [&](std::uint32_t a, std::uint32_t b, std::uint64_t parts, std::uint32_t size) {
        const std::uint64_t whole = magnitude(std::int64_t{a} - b) / (unit * parts);
        return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(whole, 1, size));
    };
    const std::uint32_t width = extent(i.texture.u, j.texture.u, 2, map.width);
    const std::uint32_t height = extent(i.texture.v, j.texture.v, 4, map.height);
    const auto sum = [&](const Vertex& v) {
        const Texel at = texel(v.texture);
        return static_cast<std::int64_t>(map_.sum(first_texel(at.x, width, map.width, map.address_u),
                                                  first_texel(at.y, height, map.height, map.address_v), width, height));
    };
    result.rectangle_area = std::uint64_t{width} * height;
    result.summed_height = magnitude(2 * sum(inserted) - sum(i) - sum(j));
    return result;
}

std::uint8_t DirectEdge::tests(const Vertex& i, const Vertex& j, const Vertex& inserted,
                               const EdgeMeasures& measures) const {
    const datapath::TestParameters& parameters = registers_.tests;
    unsigned bits = 0;
    const auto set = [&](bool yes, datapath::TestBits bit) { bits |= yes ? unsigned{bit} : 0U; };
    set(parameters.normal_test && measures.normal > parameters.normal_threshold, datapath::normal_bit);
    set(parameters.highlight_test && measures.normal > parameters.highlight_normal_threshold &&
            measures.cosine > parameters.highlight_cosine,
        datapath::highlight_bit);
    const bool by_area = parameters.summed_height_unit == datapath::SummedHeightUnit::area;
    set(parameters.summed_height_test && Wide{measures.summed_height} > Wide{parameters.height_threshold()} *
                                                                            (by_area ? measures.rectangle_area : 1),
        datapath::summed_height_bit);
    const int in_front = (i.screen.in_front ? 1 : 0) + (j.screen.in_front ? 1 : 0);
    set(!parameters.view_test || in_front == 1 || (in_front == 2 && measures.length > parameters.view_threshold),
        datapath::view_bit);
    const datapath::Formats& formats = registers_.formats;
    const std::int64_t part = (std::int64_t{1} << formats.texture.fraction) / (1 << formats.tex_coord_fraction);
    const auto near = [&](const Vertex& end) {
        return end.texture.u / part == inserted.texture.u / part && end.texture.v / part == inserted.texture.v / part;
    };
    set(!parameters.tex_coord_test || (!near(i) && !near(j)), datapath::tex_coord_bit);
    set(!parameters.generation_test || inserted.generation <= parameters.generation_limit, datapath::generation_bit);
    return static_cast<std::uint8_t>(bits);
}

}  // namespace tessera
