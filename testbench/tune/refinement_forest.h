#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/tune/texel_error.h"

namespace tessera {

/// The mesh produced by one set of thresholds.
struct Outcome {
    std::uint64_t triangles = 0;
    bool complete = true;         ///< false: stopped at the limit; the rest is then meaningless
    double rms = 0;               ///< of TexelError, weighted; model units
    double max = 0;               ///< model units
    std::uint8_t generation = 0;  ///< highest generation of a vertex; only with measurement
};

/// All triangles that the datapath can make of a job with any thresholds. Each is made once, when first reached, and
/// each edge stores the values that its tests compare (the largest difference of normals, the difference of sums,
/// pixels), not their decisions. Other thresholds then cost three comparisons per edge, about a thirtieth of the
/// datapath's work. The mesh equals the datapath's, bit for bit (tested).
///
/// Memory: about 200 bytes per triangle and 200 per edge reached. Registers other than the tests' thresholds and the
/// triangulation come from the setup and must not change.
class RefinementForest {
  public:
    /// `setup` must outlive it; its height test compares one value with a threshold. `errors`: measures triangles; may be null for a forest that only counts.
    /// Here and below: std::logic_error if the height test decides otherwise than by that value.
    RefinementForest(const MachineSetup& setup, const TexelError* errors);

    /// Counts the triangles; stops at `limit`.
    Outcome count(const datapath::TestParameters& tests, datapath::Triangulation triangulation, std::uint64_t limit);
    /// Counts and measures them.
    Outcome measure(const datapath::TestParameters& tests, datapath::Triangulation triangulation, std::uint64_t limit);

    /// The finished triangles' corners, as in the datapath.
    std::vector<std::array<datapath::Vertex, 3>> mesh(const datapath::TestParameters& tests,
                                                      datapath::Triangulation triangulation);

  private:
    struct Edge {
        std::uint64_t height = 0;     ///< the value that the height test compares, HeightTestFunctions::compared
        std::uint32_t normal = 0;     ///< the largest of the six differences
        std::uint32_t weight = 1;     ///< HeightTestFunctions::weight
        std::uint32_t view = 0;       ///< Manhattan length; both ends behind the near plane: 0, one: the largest number
        std::uint32_t middle = 0;     ///< vertex
        bool open = false;            ///< Tex Coord Test
        std::uint8_t generation = 0;  ///< of the vertex inserted
    };
    struct Node {
        std::array<Edge, 3> edges;  ///< copies: a walk reads them one after another
        std::array<std::uint32_t, 3> vertices;
        std::array<std::uint32_t, 10> children;  ///< first child, by kind of split; 0: not made yet
        std::uint32_t base;
        std::uint8_t shorter_is_second = 0;  ///< bit k: with only edge k unsplit
        bool measured = false;
        TexelError::Sum error;
    };

    template <class Leaf>
    Outcome walk(const datapath::TestParameters& tests, datapath::Triangulation triangulation, std::uint64_t limit,
                 Leaf&& leaf);
    bool splits(const Edge& edge, const datapath::TestParameters& tests) const;
    std::uint32_t make_node(const std::array<std::uint32_t, 3>& vertices, std::uint32_t base);
    std::uint32_t children_of(std::uint32_t node, unsigned split, bool second);
    const Edge& edge_between(std::uint32_t i, std::uint32_t j);
    Edge make_edge(const datapath::Vertex& i, const datapath::Vertex& j);

    BareRecursion datapath_;
    const MachineSetup& setup_;
    const datapath::HeightTestFunctions& height_test_;
    const TexelError* errors_;
    std::vector<datapath::Vertex> vertices_;
    std::vector<Edge> edges_;
    std::unordered_map<std::uint64_t, std::uint32_t> edge_of_;  // by its ends, the smaller index first
    std::vector<Node> nodes_;                                   // base triangles first
    std::size_t roots_ = 0;
    std::vector<std::uint32_t> work_;
};

}  // namespace tessera
