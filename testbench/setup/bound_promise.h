#pragma once
#include <array>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/prepared_scene.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// What the promise of tests.bound_threshold depends on. An entry bounds the error of the hierarchy's triangles only. A
/// split that another test requests leaves triangles with other edges, and a midpoint raised to a peak of the map moves
/// points beside it away from their heights. Such requests cannot be kept in the hierarchy's order: which edge is next
/// depends on the triangle, and an edge's two triangles would disagree.
struct BoundFacts {
    TestSettings tests;
    datapath::HeightTest height_test = datapath::HeightTest::summed_height;
    datapath::Triangulation triangulation = datapath::Triangulation::shorter;
    bool culling = false;
    bool fitted = false;         ///< the displacement map holds fitted heights
    bool lattice = false;        ///< the base mesh is mesh.source = "lattice"
    bool closed = true;          ///< no two midpoints share an entry
    bool reaches_all = true;     ///< midpoints reach every texel
    bool in_order = true;        ///< no bound was lowered to fit its entry
    bool in_picture = false;     ///< the threshold is in pixels
    int bound_bits = 0;          ///< of the Rank Table
    int generations = 0;         ///< highest of the midpoints that the threshold requests
    double least_threshold = 0;  ///< on the surface: full scale
};

/// A condition of that promise.
struct BoundCondition {
    const char* setting;  ///< that meets it, in a job
    const char* why;      ///< what happens without it
    bool (*met)(const BoundFacts&);
    const char* where = "";  ///< it matters; empty: everywhere
};

/// All conditions: remarks and testbench/check/PROMISES.md are derived from this table. Besides,
/// positions are rounded (formats.position_bits), and the picture is cut at camera.near_plane: a run measures their
/// effect (testbench/compare/bound_check.h).
inline constexpr std::array bound_conditions{
    BoundCondition{"hardware.height_test = \"rank\"", "only the Rank Table has bounds",
                   [](const BoundFacts& f) { return f.height_test == datapath::HeightTest::rank; }},
    BoundCondition{"formats.bound_bits = 8", "the Rank Table has no bounds",
                   [](const BoundFacts& f) { return f.bound_bits > 0; }},
    BoundCondition{"tests.summed_height = true", "the Rank Test is off and requests no split",
                   [](const BoundFacts& f) { return f.tests.summed_height; }},
    BoundCondition{"hardware.triangulation = \"greatest_rank\"", "splits in another order give other edges",
                   [](const BoundFacts& f) { return f.triangulation == datapath::Triangulation::greatest_rank; }},
    BoundCondition{"mesh.source = \"lattice\"",
                   "on another base mesh midpoints are off the map's points, and normals differ",
                   [](const BoundFacts& f) { return f.lattice; }},
    BoundCondition{"a mesh.spacing that divides each side on which the map repeats",
                   "midpoints share entries of the Rank Table", [](const BoundFacts& f) { return f.closed; }},
    BoundCondition{"formats.texture_fraction = 1", "texture coordinates without a fraction miss the centres of texels",
                   [](const BoundFacts& f) { return !f.lattice || f.reaches_all; }},
    BoundCondition{"tests.normal = false", "the Normal Test splits edges in another order, which gives other edges",
                   [](const BoundFacts& f) { return !f.tests.normal; }},
    BoundCondition{"tests.highlight = false",
                   "the Highlight Test splits edges in another order, which gives other edges",
                   [](const BoundFacts& f) { return !f.tests.highlight; }},
    BoundCondition{"tests.view = false", "the View Test may stop a split that is needed",
                   [](const BoundFacts& f) { return !f.tests.view; }},
    BoundCondition{
        "tests.generation = false", "the Generation Test may stop a split that is needed",
        [](const BoundFacts& f) { return !f.tests.generation || f.generations <= f.tests.generation_limit; }},
    BoundCondition{"map.heights = \"given\"", "fitted heights are not the map's",
                   [](const BoundFacts& f) { return !f.fitted; }},
    BoundCondition{"hardware.culling = \"none\"", "culled triangles leave points of the map without a mesh",
                   [](const BoundFacts& f) { return !f.culling; }},
    BoundCondition{"formats.bound_bits = 16",
                   "the bounds of midpoints that depend on one another do not fit their entries",
                   [](const BoundFacts& f) { return !f.in_picture || f.in_order; }, "in the picture"},
    BoundCondition{
        "tests.bound_threshold above the rounding of heights to codes (formats.displacement_bits)",
        "the threshold is below the rounding of heights to codes",
        [](const BoundFacts& f) { return f.in_picture || f.tests.threshold("bound_threshold") >= f.least_threshold; }},
};

/// The setting, and where it matters.
std::string as_text(const BoundCondition& condition);

/// Whether the settings ask for a bound: the Rank Table has bounds, or the threshold was set.
bool asks_for_bound(const SceneSettings& settings);

/// The conditions that a prepared scene does not meet; all are met if the settings do not ask for a bound.
std::vector<const BoundCondition*> broken_bound_conditions(const SceneSettings& settings, const BaseMesh& mesh,
                                                           const PreparedScene& scene);

/// Sets bound_asked and bound_promised, and adds a remark that names the broken conditions, if there are any.
void remark_on_bound(const SceneSettings& settings, const BaseMesh& mesh, PreparedScene& scene);

}  // namespace tessera
