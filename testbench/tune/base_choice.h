#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// A base mesh that the tuner may choose: the job's own, a plane with other columns and rows, or a lattice; and whether
/// it is searched with a Rank Test (or a Bound Test) or with the paper's tests.
///
/// A lattice is a plane's base mesh whose inner grid lines lie at texel centres a power of two apart, so that midpoints
/// lie at texel centres too, down to a spacing of one texel. The hardware reads the texel that contains t: a vertex at
/// a texel's border reads a height up to half a texel away, one at a texel's centre its own. On steep ground this is
/// the error that remains if all edges split: on Crater Lake 3.2 m RMS with base vertices on borders a power of two
/// apart, 1.2 m at centres. The outermost inner lines are half to one spacing away from the border. Written as OBJ. For
/// a Rank Test, whose edges have even length, the lattice is that of mesh.source = "lattice", which extends beyond the
/// map.
struct BaseChoice {
    enum class Kind { job, plane, lattice } kind = Kind::job;
    std::int64_t columns = 0, rows = 0;  ///< quads
    std::int64_t spacing = 0;            ///< lattice: texels
    bool alternate = false;              ///< lattice: the quads' diagonals alternate, like a chessboard's colours
    bool ranks = false;                  ///< with a Rank Test

    std::uint64_t triangles() const { return 2 * static_cast<std::uint64_t>(columns * rows); }
    std::string name() const;  ///< "16 x 22", "lattice of 32 texels, 11 x 15"
};

/// Kind::lattice with this spacing, for a map of the given size.
BaseChoice lattice_choice(std::int64_t spacing, bool alternate, std::int64_t map_width, std::int64_t map_height);

/// Lattices for a Rank Test with 2 to `most_triangles` triangles, in all spacings possible for the map.
std::vector<BaseChoice> rank_lattices(const Job& job, std::int64_t map_width, std::int64_t map_height,
                                      std::uint64_t most_triangles);

/// Grid lines across `texels`: 0, texel centres `spacing` apart, `texels`.
std::vector<double> lattice_lines(std::int64_t texels, std::int64_t spacing);

/// The lattice as OBJ text, scaled to the job's mesh.width and mesh.depth.
std::string lattice_obj(const BaseChoice& choice, const Job::Mesh& mesh, std::int64_t map_width,
                        std::int64_t map_height);

/// Planes with nearly square cells, and lattices, of 2 to `most_triangles` triangles.
std::vector<BaseChoice> usual_bases(const Job::Mesh& mesh, std::int64_t map_width, std::int64_t map_height,
                                    std::uint64_t most_triangles);

}  // namespace tessera
