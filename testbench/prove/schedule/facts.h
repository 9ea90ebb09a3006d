#pragma once
#include <array>
#include <cstdint>

namespace tessera::schedule {

/// The parts of a triangle, one bit each: three vertices, three normals, three edges.
constexpr unsigned parts_of_a_triangle = 9;
constexpr unsigned first_edge_part = 6;
constexpr unsigned vertex_parts = 0007, edge_parts = 0700;

/// The table entries that a unit read for one part of a triangle: up to three requests, one after another, all to the
/// same one of its memories.
struct PartReads {
    static constexpr unsigned most_requests = 3;
    static constexpr unsigned most_entries = 27;

    std::uint8_t requests = 0;
    std::uint8_t memory = 0;                            ///< which of the unit's memories
    std::array<std::uint8_t, most_requests + 1> first;  ///< index of each request's first entry; then their number
    std::array<std::uint8_t, most_entries> banks;       ///< of each entry

    const std::uint8_t* banks_of(unsigned request) const { return &banks[first[request]]; }
    unsigned entries_of(unsigned request) const { return first[request + 1] - unsigned{first[request]}; }
};

/// Where Pass or Tessellate sends a triangle.
enum class Way : std::uint8_t { tessellation, lighting, dropped };

/// What a pass of a triangle through the machine depends on, besides the design.
struct Facts {
    using Reads = std::array<PartReads, parts_of_a_triangle>;

    std::uint16_t parts = 0;  ///< parts that are not known yet
    bool tested = false;      ///< the vertices and edges go to the tests; false: only normals are missing
    Reads displace_vertex, height_test, normal_test;
    Way way = Way::dropped;
    unsigned children = 0;
    std::array<std::uint32_t, 4> place{};  ///< where the caller keeps each child
};

}  // namespace tessera::schedule
