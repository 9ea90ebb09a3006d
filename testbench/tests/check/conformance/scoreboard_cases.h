#pragma once
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/common/random.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/prove/random_edges/datapath_edge.h"

/// Random designs, maps, views and triangles for the scoreboard's tests.
namespace tessera::testing {

inline datapath::Formats make_formats(int position_bits, int position_fraction, int normal_bits, int normal_fraction,
                                      int texture_fraction, int displacement_bits, int screen_bits,
                                      int screen_fraction) {
    datapath::Formats formats;
    formats.position = datapath::Format::make_signed(position_bits, position_fraction);
    formats.view_distance = formats.position;
    formats.normal = datapath::Format::make_signed(normal_bits, normal_fraction);
    formats.texture = datapath::Format::make_unsigned(12 + texture_fraction + 1, texture_fraction);
    formats.displacement = datapath::Format::make_unsigned(displacement_bits, displacement_bits);
    formats.screen = datapath::Format::make_signed(screen_bits, screen_fraction);
    return formats;
}

inline datapath::Formats bilinear(datapath::Formats formats) {
    formats.filter = datapath::MapFilter::bilinear;
    return formats;
}

/// Default formats first, then narrow, wide and unbalanced ones.
inline std::vector<datapath::Formats> many_formats() {
    return {datapath::Formats{},
            make_formats(32, 31, 18, 16, 12, 16, 32, 8),
            make_formats(32, 0, 18, 16, 12, 16, 32, 20),
            make_formats(24, 12, 12, 10, 8, 12, 20, 4),
            make_formats(16, 8, 10, 8, 4, 8, 16, 2),
            make_formats(12, 6, 8, 5, 2, 4, 12, 0),
            make_formats(8, 4, 6, 4, 0, 1, 8, 0),
            make_formats(32, 16, 6, 4, 12, 16, 24, 8),
            make_formats(10, 2, 18, 16, 12, 16, 32, 16),
            bilinear(datapath::Formats{}),
            bilinear(make_formats(32, 31, 18, 16, 12, 16, 32, 8)),
            bilinear(make_formats(16, 8, 10, 8, 4, 8, 16, 2)),
            bilinear(make_formats(8, 4, 6, 4, 0, 1, 8, 0))};
}

inline double real(Random& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random.integer(0, 1 << 30)) / static_cast<double>(1 << 30);
}

inline glm::dvec3 unit_vector(Random& random) {
    for (;;) {
        const glm::dvec3 v{real(random, -1, 1), real(random, -1, 1), real(random, -1, 1)};  // braces fix the order
        const double length = glm::length(v);
        if (length > 0.1 && length < 1)
            return v / length;
    }
}

inline datapath::Direction rounded(const glm::dvec3& v, const datapath::Format& format) {
    const auto component = [&](double value) {
        return static_cast<std::int32_t>(std::lround(std::ldexp(value, format.fraction)));
    };
    return {component(v.x), component(v.y), component(v.z)};
}

/// How extreme the operands are.
enum class Manner {
    tame,  ///< like a mesh in front of a camera: nothing saturates, neighbouring normals within about 30
           ///< degrees
    wild   ///< anything the formats hold
};

/// A design with its map and view, and the models that evaluate it.
struct Case {
    MachineSetup setup;
    GoldenInputs inputs;
    EdgeMachine machine;
    Manner manner;

    static MachineSetup make_setup(Random& random, const datapath::Formats& formats, Manner manner) {
        MachineSetup setup;
        datapath::Registers& registers = setup.registers;
        registers.formats = formats;
        const auto mode = [&] { return random.coin() ? datapath::AddressMode::repeat : datapath::AddressMode::clamp; };
        registers.map = {random.natural(1, 90), random.natural(1, 70), mode(), mode()};
        setup.map.geometry = registers.map;
        setup.map.bits = formats.displacement.bits;
        for (std::uint32_t k = 0; k < registers.map.width * registers.map.height; ++k)
            setup.map.codes.push_back(static_cast<std::uint16_t>(random.natural(0, setup.map.highest_code())));

        const std::int64_t highest = formats.position.highest;
        const std::int64_t reach = manner == Manner::wild ? highest : highest / 8;
        registers.displacement = {random.integer32(-reach, reach), random.integer32(-reach, reach)};
        setup.height_per_code =
            std::ldexp(static_cast<double>(registers.displacement.scale), -formats.position.fraction - setup.map.bits);
        const double world = std::ldexp(static_cast<double>(highest), -formats.position.fraction);
        setup.texel_size = {real(random, 0.01, 2) * world, real(random, 0.01, 2) * world};

        datapath::TestParameters& tests = registers.tests;
        tests.normal_threshold = random.natural(0, 1u << formats.normal.fraction);
        tests.summed_height_unit = random.coin() ? datapath::SummedHeightUnit::area : datapath::SummedHeightUnit::sum;
        tests.height_thresholds[0] = random.natural(0, setup.map.highest_code());
        tests.view_threshold = random.natural(0, 200u << std::min(formats.screen.fraction, 8));
        tests.generation_limit = random.natural(0, 15);
        registers.triangulation = static_cast<datapath::Triangulation>(random.natural(0, 2));

        make_view(random, registers, manner);
        return setup;
    }

    /// A camera looking at the origin, from well outside (tame) or from anywhere (wild).
    static void make_view(Random& random, datapath::Registers& registers, Manner manner) {
        const int fraction = datapath::TransformParameters::matrix_fraction;
        const int position = registers.formats.position.fraction;
        const double world = std::ldexp(static_cast<double>(registers.formats.position.highest), -position);
        const glm::dvec3 forward = unit_vector(random);
        const glm::dvec3 right = glm::normalize(glm::cross(forward, unit_vector(random) + 0.01));
        const glm::dvec3 up = glm::cross(right, forward);
        const glm::dvec3 eye = -forward * world * (manner == Manner::wild ? real(random, -1, 2) : 1.5);
        const double pixels =
            std::ldexp(static_cast<double>(registers.formats.screen.highest), -registers.formats.screen.fraction);
        const double half = std::min(pixels / 4, 500.0);
        datapath::TransformParameters& transform = registers.transform;
        transform.exponent = std::max(0, static_cast<int>(std::ceil(std::log2(3 * half))));
        const auto row = [&](const glm::dvec3& direction) {
            const auto fixed = [&](double value, int bits) {
                return static_cast<std::int64_t>(std::nearbyint(std::ldexp(value, bits)));
            };
            return std::array<std::int64_t, 4>{fixed(direction.x, fraction), fixed(direction.y, fraction),
                                               fixed(direction.z, fraction),
                                               fixed(-glm::dot(direction, eye), fraction + position)};
        };
        const double scale = std::ldexp(1.0, -transform.exponent);
        transform.row_x = row((2 * half * right + half * forward) * scale);
        transform.row_y = row((2 * half * up + half * forward) * scale);
        transform.row_w = row(forward);
        transform.near_plane = static_cast<std::int64_t>(std::ldexp(world * 0.001, fraction + position));
    }

    Case(const MachineSetup& made, Manner how)
        : setup(made), inputs(setup), machine(make_machine(setup)), manner(how) {}
    Case(Random& random, const datapath::Formats& formats, Manner how) : Case(make_setup(random, formats, how), how) {}

    static EdgeMachine make_machine(MachineSetup& setup) {
        std::vector<datapath::Direction> normals;
        for (std::uint32_t y = 0; y < setup.map.geometry.height; ++y)
            for (std::uint32_t x = 0; x < setup.map.geometry.width; ++x)
                normals.push_back(map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size,
                                             setup.registers.formats.normal));
        const Tables tables = make_tables(
            setup.registers, std::vector<std::uint32_t>(setup.map.codes.begin(), setup.map.codes.end()), normals);
        return EdgeMachine(setup.registers, tables);
    }

    datapath::Vertex vertex(Random& random, const datapath::Vertex& neighbour) {
        const datapath::Registers& registers = setup.registers;
        const datapath::Formats& formats = registers.formats;
        const bool wild = manner == Manner::wild;
        const std::int64_t reach = wild ? formats.position.highest : formats.position.highest / 2;
        const auto coordinate = [&] {
            return static_cast<std::int32_t>(wild ? random.any_size(reach) : random.integer(-reach, reach));
        };
        datapath::Vertex v;
        v.position = {coordinate(), coordinate(), coordinate()};
        const glm::dvec3 before = Dequantise(formats).direction(neighbour.normal);
        glm::dvec3 n = unit_vector(random);
        if (!wild && neighbour.generation != 255)
            n = glm::normalize(before + 0.4 * n);
        else if (wild && random.integer(0, 3) == 0)
            n = -before + real(random, 0, 0.01) * n;  // the mean nearly cancels
        v.normal = rounded(n, formats.normal);
        glm::dvec3 tangent = unit_vector(random);
        if (!wild) {  // orthogonal to the normal, and near the neighbour's
            if (neighbour.generation != 255)
                tangent = Dequantise(formats).direction(neighbour.tangent) + 0.2 * tangent;
            else if (std::abs(glm::dot(tangent, n)) > 0.8)
                tangent = glm::dvec3(n.y, n.z, n.x) - 0.5 * n;
            tangent = glm::normalize(tangent - glm::dot(tangent, n) * n);
        }
        v.tangent = rounded(tangent, formats.normal);
        if (wild && random.integer(0, 15) == 0)
            v.normal = {};
        if (wild && random.integer(0, 15) == 0)
            v.tangent = {};
        v.handedness = wild && random.coin() ? std::int8_t{-1} : std::int8_t{1};
        v.texture = {random.natural(0, registers.map.width << formats.texture.fraction),
                     random.natural(0, registers.map.height << formats.texture.fraction)};
        v.generation = static_cast<std::uint8_t>(random.natural(0, wild ? 15 : 6));
        return v;
    }

    /// A complete pass of three related vertices; every second one is a base triangle's first pass.
    datapath::TrianglePass pass(Random& random) {
        datapath::Triangle triangle;
        datapath::Vertex before;
        before.generation = 255;  // none
        for (datapath::Vertex& v : triangle.vertices) {
            v = vertex(random, before);
            before = v;
        }
        return evaluate(triangle, random.coin());
    }
    datapath::TrianglePass evaluate(datapath::Triangle triangle, bool base) {
        machine.complete_base(triangle);
        datapath::TrianglePass result = machine.evaluate(triangle);
        result.tested = true;
        result.new_vertices = base ? 7 : 0;
        return result;
    }
};

inline const ConformanceResult::Quantity& quantity(const ConformanceResult& result, const std::string& name) {
    for (const auto& q : result.quantities)
        if (q.name == name)
            return q;
    FAIL("no quantity " << name);
    return result.quantities.front();
}

inline const ConformanceResult::Test& test(const ConformanceResult& result, const std::string& name) {
    for (const auto& t : result.tests)
        if (t.name == name)
            return t;
    FAIL("no test " << name);
    return result.tests.front();
}

inline ConformanceResult check(const Case& c, const std::vector<datapath::TrianglePass>& passes) {
    Scoreboard scoreboard(c.setup.registers, c.inputs);
    for (const datapath::TrianglePass& pass : passes)
        scoreboard.write(pass);
    return scoreboard.result();
}
inline ConformanceResult check(const Case& c, const datapath::TrianglePass& pass) {
    return check(c, std::vector<datapath::TrianglePass>{pass});
}

}  // namespace tessera::testing
