#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"

namespace tessera {

/// The map, with sums of heights that do not wrap: a table over two periods on each axis, 64 bits per entry.
class DirectMap {
  public:
    DirectMap(const datapath::MapGeometry& geometry, std::vector<std::uint32_t> codes,
              std::vector<datapath::Direction> normals);

    std::uint32_t code(std::int64_t x, std::int64_t y) const { return codes_[index(x, y)]; }
    const datapath::Direction& normal(std::int64_t x, std::int64_t y) const { return normals_[index(x, y)]; }
    /// Sum of the codes in columns x .. x + width, rows y .. y + height; x, y inside the map, the size no larger.
    std::uint64_t sum(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) const;

  private:
    /// Index of a texel; outside the map the border's texel, or the texel whole periods away.
    std::size_t index(std::int64_t x, std::int64_t y) const;

    datapath::MapGeometry geometry_;
    std::vector<std::uint32_t> codes_;
    std::vector<datapath::Direction> normals_;
    std::vector<std::uint64_t> sums_;
};

/// The values that an edge's tests compare with their thresholds.
struct EdgeMeasures {
    std::uint64_t normal = 0;          ///< largest of the six differences
    std::uint64_t summed_height = 0;   ///< | 2 S_ij - S_i - S_j |
    std::uint64_t rectangle_area = 1;  ///< texels of each of the three rectangles
    std::uint64_t length = 0;          ///< Manhattan, on screen
    std::int64_t cosine = 0;           ///< largest N'.H of the three normals
};

/// A second implementation of the arithmetic's definitions, which shares no function with the datapath: divisions that
/// round down instead of shifts, sums of texels, and square roots and quotients in double precision instead of tables
/// and Newton steps.
class DirectEdge {
  public:
    DirectEdge(const datapath::Registers& registers, const DirectMap& map) : registers_(registers), map_(map) {}

    /// Compares the vertex inserted on (i, j) with the definitions: quotients and unit vectors within the documented
    /// bounds, all other components exactly. Null, or the name of a wrong value.
    const char* fault_of_vertex(const datapath::Vertex& i, const datapath::Vertex& j,
                                const datapath::Vertex& inserted) const;

    EdgeMeasures measure(const datapath::Vertex& i, const datapath::Vertex& j, const datapath::Vertex& inserted) const;

    /// The six tests as TestBits.
    std::uint8_t tests(const datapath::Vertex& i, const datapath::Vertex& j, const datapath::Vertex& inserted,
                       const EdgeMeasures& measures) const;

  private:
    struct Texel {
        std::uint32_t x, y;
    };
    Texel texel(const datapath::TexCoord& t) const;
    /// A value of the map at t, sampled as in the design, with `fraction` fraction bits if it is interpolated.
    template <class Value>
    std::int64_t read(const datapath::TexCoord& t, int fraction, Value value) const;
    std::uint32_t first_texel(std::uint32_t coordinate, std::uint32_t extent, std::uint32_t size,
                              datapath::AddressMode mode) const;
    bool is_unit(const std::array<std::int64_t, 3>& vector, const datapath::Direction& unit) const;
    bool is_bumped(const datapath::Vertex& vertex) const;
    bool is_displaced(const datapath::Vertex& vertex) const;
    bool is_on_screen(const datapath::Vertex& vertex) const;

    const datapath::Registers& registers_;
    const DirectMap& map_;
};

}  // namespace tessera
