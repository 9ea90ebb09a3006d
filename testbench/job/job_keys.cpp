#include "testbench/job/job_keys.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "modules/datapath/format.h"
#include "modules/timing/timing_keys.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

constexpr double any_length = 1e6;       // model units; keeps products of lengths far from overflow
constexpr double least_length = 1e-6;    // and quotients far from infinity
constexpr double any_coordinate = 1e12;  // of a camera: what maps of a country or of a cell may have
constexpr double any_count = 2147483647;
constexpr double most_trace = 9e15;  // cycles; whole numbers a double holds

constexpr KeyRange length_range{least_length, any_length};
constexpr KeyRange coordinate_range{-any_coordinate, any_coordinate};
constexpr KeyRange distance_range{1 / any_coordinate, any_coordinate};

KeyRange between(double low, double high) {
    return {low, high};
}
KeyRange zero_or_between(double low, double high) {
    return {low, high, true};
}
KeyRange auto_or(KeyRange range) {
    range.or_auto = true;
    return range;
}

template <typename T>
JobValue value_or_auto(const T& value, const KeyRange& range) {
    if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, std::array<double, 3>>) {
        if (range.or_auto && is_automatic(value))
            return std::string(auto_word);
    }
    return value;
}

template <typename T>
T from_value(const JobValue& value) {
    if constexpr (std::is_same_v<T, double>)
        return std::holds_alternative<double>(value) ? std::get<double>(value) : automatic;
    else if constexpr (std::is_same_v<T, std::array<double, 3>>)
        return std::holds_alternative<T>(value) ? std::get<T>(value) : automatic_vector;
    else
        return std::get<T>(value);
}

/// In the order of MapRange::Kind.
constexpr std::array<std::string_view, 2> range_names{"full", "data"};

/// Fills one table; `Group` is the struct of Job whose members the keys set.
template <typename Group, typename Select>
class TableWriter {
  public:
    TableWriter(KeyTable& table, Select select) : table_(table), select_(select) {}

    void add(const char* leaf, bool Group::*member, const char* description) const {
        add_plain(leaf, member, KeyKind::flag, "-", {}, description);
    }
    void add(const char* leaf, std::int64_t Group::*member, const char* unit, KeyRange range,
             const char* description) const {
        add_plain(leaf, member, KeyKind::integer, unit, range, description);
    }
    void add(const char* leaf, double Group::*member, const char* unit, KeyRange range, const char* description) const {
        add_plain(leaf, member, KeyKind::number, unit, range, description);
    }
    void add(const char* leaf, std::array<double, 3> Group::*member, const char* unit, KeyRange range,
             const char* description) const {
        add_plain(leaf, member, KeyKind::vector, unit, range, description);
    }
    void add(const char* leaf, std::string Group::*member, KeyKind kind, const char* description) const {
        add_plain(leaf, member, kind, "-", {}, description);
    }
    void add(const char* leaf, MapRange Group::*member, const char* unit, KeyRange range,
             const char* description) const {
        Key& key = push(leaf, KeyKind::span, unit, description);
        key.range = range;
        key.choices = {range_names.begin(), range_names.end()};
        key.get = [select = select_, member](const Job& job) -> JobValue {
            const MapRange& it = select(job).*member;
            if (it.kind == MapRange::Kind::given)
                return std::array<double, 2>{it.low, it.high};
            return std::string(range_names.at(static_cast<std::size_t>(it.kind)));
        };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            MapRange& it = select(job).*member;
            it = {};
            if (const auto* const ends = std::get_if<std::array<double, 2>>(&value)) {
                it = {MapRange::Kind::given, (*ends)[0], (*ends)[1]};
            } else if (std::get<std::string>(value) == range_names.back()) {
                it.kind = MapRange::Kind::data;
            }
        };
    }
    template <typename Enum, typename = std::enable_if_t<std::is_enum_v<Enum>>>
    void add(const char* leaf, Enum Group::*member, const char* description) const {
        add_choice<Enum>(
            leaf, [member](auto& group) -> auto& { return group.*member; }, description);
    }

    /// One of an enumeration's values: `member(group)` is a reference to it.
    template <typename Enum, typename Member>
    void add_choice(const std::string& leaf, Member member, const std::string& description) const {
        Key& key = push(leaf, KeyKind::choice, "-", description);
        key.choices = names_of<Enum>();
        key.get = [select = select_, member](const Job& job) { return std::string(name_of(member(select(job)))); };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            const std::vector<std::string_view> names = names_of<Enum>();
            const auto found = std::find(names.begin(), names.end(), std::get<std::string>(value));
            member(select(job)) = static_cast<Enum>(found - names.begin());
        };
    }

    /// An unsigned or std::uint64_t number deep within the group: `member(group)` is a reference to it.
    template <typename Member>
    void add_number(const std::string& leaf, Member member, const char* unit, TimingRange range,
                    const std::string& description) const {
        Key& key = push(leaf, KeyKind::integer, unit, description);
        key.range = between(range.least, range.most);
        key.get = [select = select_, member](const Job& job) { return static_cast<std::int64_t>(member(select(job))); };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            auto& it = member(select(job));
            it = static_cast<std::remove_reference_t<decltype(it)>>(std::get<std::int64_t>(value));
        };
    }

  private:
    template <typename T>
    void add_plain(const char* leaf, T Group::*member, KeyKind kind, const char* unit, KeyRange range,
                   const char* description) const {
        Key& key = push(leaf, kind, unit, description);
        key.range = range;
        key.get = [select = select_, member, range](const Job& job) {
            return value_or_auto(select(job).*member, range);
        };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            select(job).*member = from_value<T>(value);
        };
    }

    Key& push(const std::string& leaf, KeyKind kind, const char* unit, const std::string& description) const {
        Key key;
        key.name = table_.name.empty() ? leaf : table_.name + '.' + leaf;
        key.kind = kind;
        key.unit = unit;
        key.description = description;
        table_.keys.push_back(std::move(key));
        return table_.keys.back();
    }

    KeyTable& table_;
    Select select_;
};

class TableList {
  public:
    /// Declares the table of one member of Job: its name, its description, then its keys, one line each.
    template <typename Group, typename Declare>
    void table(const char* name, Group Job::*group, const char* description, Declare declare) {
        const auto select = [group](auto& job) -> auto& {
            return job.*group;
        };
        declare_table<Group>(name, description, select, declare);
    }

    template <typename Declare>
    void top_level(const char* description, Declare declare) {
        const auto select = [](auto& job) -> auto& {
            return job;
        };
        declare_table<Job>("", description, select, declare);
    }

    std::vector<KeyTable> take() { return std::move(tables_); }

  private:
    template <typename Group, typename Select, typename Declare>
    void declare_table(const char* name, const char* description, Select select, Declare declare) {
        tables_.push_back({name, description, {}});
        declare(TableWriter<Group, Select>(tables_.back(), select));
    }

    std::vector<KeyTable> tables_;
};

// The declaration of every key. The default is the member's initialiser in job.h.
std::vector<KeyTable> declare_keys() {
    TableList list;
    // clang-format off
    list.top_level("How the model runs.", [](const auto& key) {
        key.add("mode", &Job::mode, "functional: every result but no cycle counts, fastest; timed: accurate to the cycle");
    });
    list.table("mesh", &Job::mesh, "The base mesh.", [](const auto& key) {
        using Mesh = Job::Mesh;
        key.add("source", &Mesh::source, "A built-in shape; file: the mesh in mesh.file (the default if mesh.file is given); patches: the Bezier patches in it; run: the mesh of an earlier run; lattice: a plane whose vertices lie at centres of texels, mesh.spacing apart, and which reaches beyond the map where that does not divide it");
        key.add("file", &Mesh::file, KeyKind::file, "OBJ file, with mesh.source = \"file\"; with \"patches\" one of bicubic Bezier patches as Newell's teapot has it; with \"run\" the folder of an earlier run");
        key.add("fingerprint", &Mesh::fingerprint, KeyKind::text, "64-bit FNV-1a hash of the file (of a run's mesh.ply), 16 hexadecimal digits; another file is refused. A run writes it into its job.toml; empty: any file");
        key.add("columns", &Mesh::columns, "quads", between(0, 2048), "Quads along u; 0: 3 for the plane, 4 for each patch, 32 for cylinder and sphere, which need 3 or more");
        key.add("rows", &Mesh::rows, "quads", between(0, 2048), "Quads along v; 0: 3 for the plane, 4 for each patch, 32 for cylinder and sphere; a sphere needs 2 or more");
        key.add("spacing", &Mesh::spacing, "texels", between(1, 2048), "Between the vertices of a lattice: a power of two");
        key.add("width", &Mesh::width, "model units", length_range, "Size of the plane along x; of the map under a lattice");
        key.add("depth", &Mesh::depth, "model units", length_range, "Size of the plane along y; of the map under a lattice");
        key.add("radius", &Mesh::radius, "model units", length_range, "Radius of the cylinder or sphere");
        key.add("height", &Mesh::height, "model units", length_range, "Height of the cylinder");
    });
    list.table("map", &Job::map, "The displacement map.", [](const auto& key) {
        using Map = Job::Map;
        key.add("source", &Map::source, "A built-in map; file: the image in map.file (the default if map.file is given)");
        key.add("file", &Map::file, KeyKind::file, "EXR, PNG or PGM file, with map.source = \"file\"");
        key.add("fingerprint", &Map::fingerprint, KeyKind::text, "64-bit FNV-1a hash of the file, 16 hexadecimal digits; another file is refused. A run writes it into its job.toml; empty: any file");
        key.add("channel", &Map::channel, KeyKind::text, "Channel of an EXR file; empty: Y, else R, else the only one");
        key.add("width", &Map::width, "texels", between(1, 4096), "Width of a built-in map");
        key.add("height", &Map::height, "texels", between(1, 4096), "Height of a built-in map");
        key.add("value", &Map::value, "full scale", between(0, 1), "Value of the constant map");
        key.add("seed", &Map::seed, "-", between(0, 4294967295.0), "Seed of the noise map");
        key.add("text", &Map::text, KeyKind::text, "Text of the text map");
        key.add("range", &Map::range, "the map's own units", coordinate_range, "Which map values displacement.scale spans: full, what the source can hold (0 to the maximum value of a PGM, to 255 or 65535 of a PNG; 0 to 1 of an EXR and of built-in maps); data, the lowest to the highest that occurs; or [low, high]. Values outside it extrapolate linearly. With data or [low, high] the displacement codes span the values that occur, and so does the full scale of tests.summed_height_threshold");
        key.add("heights", &Map::heights, "What the displacement map holds: the map's heights, or heights fitted to it: the host finds the mesh of the job's own thresholds and gives its vertices those with which its squared error at the texels' centres is least. The tests' tables stay those of the map, and errors are measured against it");
        key.add("address_u", &Map::address_u, "Beyond the map's left and right border; repeat closes a cylinder's seam");
        key.add("address_v", &Map::address_v, "Beyond the map's lower and upper border");
    });
    list.table("displacement", &Job::displacement, "From map value to height along the normal: bias + scale * (value - low) / (high - low), with low and high of map.range.", [](const auto& key) {
        using Displacement = Job::Displacement;
        key.add("scale", &Displacement::scale, "model units", auto_or(coordinate_range), "Height from the low to the high end of map.range; auto: an eighth of the base mesh's largest extent if it is flat (its smallest extent under a tenth of the next), else a fortieth; reduced where values lie outside map.range, so that the highest displacement stays the same");
        key.add("bias", &Displacement::bias, "model units", coordinate_range, "Height at the low end of map.range");
    });
    list.table("frames", &Job::frames, "Several frames that differ in the displacement's scale, each a run folder of its own: frame_000, ... in output.folder.", [](const auto& key) {
        using Frames = Job::Frames;
        key.add("count", &Frames::count, "frames", between(1, 1000), "Number of frames; frame k of n has the scale first_scale + (displacement.scale - first_scale) * k / (n - 1); 1: a plain run, of displacement.scale");
        key.add("first_scale", &Frames::first_scale, "model units", coordinate_range, "displacement.scale of frame 0; the last frame has the job's own");
    });
    list.table("camera", &Job::camera, "The view, on which the View Test depends.", [](const auto& key) {
        using Camera = Job::Camera;
        key.add("eye", &Camera::eye, "model units", auto_or(coordinate_range), "Position of the camera; auto: 20 degrees to the right of the front and 38 degrees above it, as near as the displaced model's bounding box, of all frames together, fits into 90 % of the picture's width and height. Front is -y, or z where up is y");
        key.add("target", &Camera::target, "model units", auto_or(coordinate_range), "Point it looks at; auto: the centre of that bounding box");
        key.add("up", &Camera::up, "-", auto_or(coordinate_range), "Direction that is up in the picture, of any length; auto: y for an OBJ file that is not flat, the axis it is flat in (on the side of its normals) for one that is, the earlier run's camera.up for a run on an OBJ file (or on a run), z for every other source; if the camera looks along that axis, away from the model's front");
        key.add("field_of_view", &Camera::field_of_view, "degrees", between(0.1, 179), "Vertical opening angle");
        key.add("near_plane", &Camera::near_plane, "model units", auto_or(distance_range), "Distance of the near plane; vertices on or behind it have no screen position; auto: a thousandth of the distance from eye to target");
        key.add("viewport_width", &Camera::viewport_width, "pixels", between(1, 16384), "Width of the picture");
        key.add("viewport_height", &Camera::viewport_height, "pixels", between(1, 16384), "Height of the picture");
    });
    list.table("tests", &Job::tests, "The edge tests: split = (normal or summed_height or highlight) and view and tex_coord and generation.", [](const auto& key) {
        using Tests = Job::Tests;
        key.add("normal", &Tests::normal, "Normal Test; off: never requests a split");
        key.add("normal_threshold", &Tests::normal_threshold, "unit normal component", between(0, 2), "Normal Test: a component of two normals that differs by more splits the edge");
        key.add("summed_height", &Tests::summed_height, "Summed Height Test, or the test in its place (hardware.height_test); off: never requests a split");
        key.add("summed_height_threshold", &Tests::summed_height_threshold, "full-scale texels (sum), full scale (area)", between(0, 1e9), "Summed Height Test: an edge splits where S_ij / 2 and (S_i + S_j) / 4 differ by more (sum), or 2 S_ij and S_i + S_j by more than it times the rectangle's area (area)");
        key.add("summed_height_unit", &Tests::summed_height_unit, "What the threshold compares: sums over rectangles, or the second difference of their mean heights (area)");
        key.add("rank_view", &Tests::rank_view, "With hardware.height_test = \"rank\": what its thresholds measure. none: errors of the surface; per_point, per_pixel: errors in the picture, in pixels, so that triangles are smaller nearer to camera.eye; every point of the map counts alike, or every pixel. These need hardware.test_order = \"cheap_first\"");
        key.add("rank_threshold", &Tests::rank_threshold, "full scale times the root of a texel; pixels times the root of a texel (per_point), of a pixel (per_pixel)", between(0, 1e9), "With hardware.height_test = \"rank\" and formats.rank_bits: an edge splits if its midpoint takes more off the squared error, per triangle that it costs: the root of it");
        key.add("bound_threshold", &Tests::bound_threshold, "full scale; pixels (per_point, per_pixel)", between(0, 1e6), "With hardware.height_test = \"rank\" and formats.bound_bits: no point of the map lies farther from the mesh, along the normal, or appears farther from it in the picture; of a mesh that the rank's lattice fits, with hardware.triangulation = greatest_rank");
        key.add("curvature_threshold", &Tests::curvature_threshold, "full scale times texels", between(0, 1e9), "With hardware.height_test = \"curvature\": an edge splits if the map leaves its chord by more than this over the edge's length, in texels and rounded up to a power of two");
        key.add("mipmap_filter", &Tests::mipmap_filter, "With hardware.height_test = \"mipmap\": what a block of texels has for its height, the mean or the maximum");
        key.add("mipmap_threshold", &Tests::mipmap_threshold, "full scale", between(0, 1), "With hardware.height_test = \"mipmap\": an edge splits if the filtered map at its midpoint leaves the chord between those at its ends by more");
        key.add("view", &Tests::view, "View Test; off: allows every split");
        key.add("view_threshold", &Tests::view_threshold, "pixels", between(0, 1e6), "View Test: only a longer edge (Manhattan length on screen) is split");
        key.add("tex_coord", &Tests::tex_coord, "Tex Coord Test, ends at the map's resolution; off: allows every split");
        key.add("generation", &Tests::generation, "Generation Test; off: allows every split, and a run may not end");
        key.add("generation_limit", &Tests::generation_limit, "generations", between(0, 15), "Generation Test: the highest generation a new vertex may have");
        key.add("highlight", &Tests::highlight, "Highlight Test, for per-vertex lighting: finer triangles where the Phong highlight of hardware.light is; off: the design has none");
        key.add("highlight_angle", &Tests::highlight_angle, "degrees", between(0, 90), "Highlight Test: a normal lies in the highlight if it is nearer than this to the half vector between the directions to the light and to the viewer (camera.eye - camera.target)");
        key.add("highlight_normal_threshold", &Tests::highlight_normal_threshold, "unit normal component", between(0, 2), "Highlight Test: an edge with a normal in the highlight is split if a component of two of its normals differs by more");
    });
    list.table("formats", &Job::formats, "Fixed-point formats of the hardware; bits count the sign where there is one.", [](const auto& key) {
        using Formats = Job::Formats;
        using Limits = datapath::FormatLimits;
        const auto within = [](const Limits::Range& range) { return between(range.least, range.most); };
        key.add("position_bits", &Formats::position_bits, "bits", within(Limits::position_bits), "Positions, signed");
        key.add("position_fraction", &Formats::position_fraction, "bits", within(Limits::position_fraction), "Positions: fraction bits, fewer than position_bits");
        key.add("normal_bits", &Formats::normal_bits, "bits", within(Limits::normal_bits), "Components of normals and tangents, signed");
        key.add("normal_fraction", &Formats::normal_fraction, "bits", within(Limits::normal_fraction), "Normals: fraction bits, at least 2 fewer than normal_bits");
        key.add("texture_integer", &Formats::texture_integer, "bits", within(Limits::texture_integer), "Texture coordinates, unsigned, in texels: integer bits");
        key.add("texture_fraction", &Formats::texture_fraction, "bits", within(Limits::texture_fraction), "Texture coordinates: fraction bits");
        key.add("tex_coord_fraction", &Formats::tex_coord_fraction, "bits", between(-1, Limits::tex_coord_fraction.most), "Tex Coord Test: fraction bits of texture coordinates that it compares, at most texture_fraction. 0, the paper's: it ends at texels; 1: at half texels; -1: 1 with hardware.displacement_filter = \"bilinear\", whose heights change within texels, else 0");
        key.add("displacement_bits", &Formats::displacement_bits, "bits", within(Limits::displacement_bits), "Displacement map, unsigned");
        key.add("summed_height_bits", &Formats::summed_height_bits, "bits", zero_or_between(Limits::summed_height_bits.least, Limits::summed_height_bits.most), "Summed Height Table, unsigned; 0: the narrowest of 32, 40, 48 the mesh needs");
        key.add("screen_bits", &Formats::screen_bits, "bits", within(Limits::screen_bits), "Screen positions, signed, in pixels");
        key.add("screen_fraction", &Formats::screen_fraction, "bits", within(Limits::screen_fraction), "Screen positions: fraction bits, fewer than screen_bits");
        key.add("rank_bits", &Formats::rank_bits, "bits", zero_or_between(Limits::rank_bits.least, Limits::rank_bits.most), "Rank Table: of a rank; 0: none");
        key.add("bound_bits", &Formats::bound_bits, "bits", zero_or_between(Limits::bound_bits.least, Limits::bound_bits.most), "Rank Table: of a bound; 0: none");
        key.add("generation_bits", &Formats::generation_bits, "bits", within(Limits::generation_bits), "Generation of a vertex, unsigned");
    });
    list.table("hardware", &Job::hardware, "The units' options.", [](const auto& key) {
        using Hardware = Job::Hardware;
        key.add("design", &Hardware::design, "Sets a design's keys, which a job may then set alone: the paper's, or one that leaves out what the paper's does twice (modules/README.md, Designs); the mesh is the same");
        key.add("triangulation", &Hardware::triangulation, "Diagonal when two edges split: the shorter one, or always the first or second; greatest_rank: of the edges that ask to be split the one of greatest rank is cut, with hardware.height_test = \"rank\"");
        key.add("height_test", &Hardware::height_test, "The Summed Height Test (the paper's), or in its place the Rank Test: the host ranks the points of the base mesh's lattice, and an edge splits if the rank of its midpoint is above the threshold; or the Curvature Test, for any base mesh: the host fits quadratics to the map, and an edge splits if they leave its chord; or the Mipmap Test, which the paper weighs its own against: the map filtered down to an edge's length in place of sums");
        key.add("culling", &Hardware::culling, "Back-face culling of finished triangles");
        key.add("queue_order", &Hardware::queue_order, "Triangle Queue: which waiting triangle goes next, the oldest or the newest");
        key.add("queue_watermark", &Hardware::queue_watermark, "triangles", between(1, any_count), "Host triangles are taken while fewer than this many wait");
        key.add("queue_capacity", &Hardware::queue_capacity, "triangles", between(0, any_count), "Timed mode: Triangle Queue's places on chip; 0: unbounded");
        key.add("off_chip_triangles", &Hardware::off_chip_triangles, "triangles", between(1, 1000000000), "Timed mode: places for spilled triangles in off-chip memory; a run that needs more ends with exit code 4");
        key.add("queue_overflow", &Hardware::queue_overflow, "Timed mode: a full queue spills to off-chip memory, stalls the pipeline, or ends the run with exit code 4");
        key.add("tests_units", &Hardware::tests_units, "-", between(1, 3), "Timed mode: Tessellation Tests units, 1 or 3 (one for each edge of a triangle)");
        key.add("work", &Hardware::work, "What goes round through the Triangle Queue: each triangle (the paper's), or the triangles that are known to split, whose children are then tested as a family; the mesh is the same");
        key.add("test_order", &Hardware::test_order, "All tests of an edge at once (the paper's), or those that read no table first and the others only if the decision still depends on them; the mesh is the same");
        key.add("final_edges", &Hardware::final_edges, "A child's edge that was tested with its parent and not split is not tested again; off: the paper's; the mesh is the same");
        key.add("one_texel_from_map", &Hardware::one_texel_from_map, "Vertices carry their displacement codes, and the Summed Height Test takes the sum over a rectangle of one texel from them and from the displacement map; off: the paper's, from the Summed Height Table; the mesh is the same");
        key.add("displacement_filter", &Hardware::displacement_filter, "How the displacement map and the normal map are read: the texel under a vertex (the paper's), or between the four around it; another surface, and four reads instead of one");
        key.add("edge_lanes", &Hardware::edge_lanes, "-", between(1, 9), "Timed mode, of families with the cheap tests first: edges a cycle into the cheap tests");
        key.add("normal_tests", &Hardware::normal_tests, "-", between(1, 9), "Timed mode, likewise: Normal Tests, which share the lanes' edges");
        key.add("transform_pipelines", &Hardware::transform_pipelines, "-", between(1, 16), "Timed mode: Transform pipelines that take turns");
        key.add("machines", &Hardware::machines, "-", between(1, 16), "Whole machines side by side, each with its own tables and off-chip memory; base triangle k goes to machine k modulo their number");
        key.add("direct_memory", &Hardware::direct_memory, "Functional mode reads the memories through DMI");
        key.add("light", &Hardware::light, "-", coordinate_range, "Direction towards the light, world space, of any length");
        key.add("ambient", &Hardware::ambient, "full scale", between(0, 1), "Light that falls on every surface");
    });
    list.table("timing", &Job::timing, "Timed mode: the datasheet figures of every unit and memory.", [](const auto& key) {
        key.add("engine", &Job::TimingSettings::engine, "How a run is timed, with the same results: by a schedule, several times as fast, or by a clock that calls each unit in each cycle; auto: by a schedule where the design and the options of the run have one (modules/schedule/README.md)");
        declare_timing_keys(key);
    });
    list.table("check", &Job::check, "What a run checks.", [](const auto& key) {
        using Check = Job::Check;
        key.add("golden", &Check::golden, "Every edge's decision against the golden model (scoreboard), and every register and table entry against what golden derives from the job by itself");
        key.add("end_to_end", &Check::end_to_end, "Golden run of the whole mesh, compared with the hardware's; also every register and table entry, as with check.golden");
        key.add("invariants", &Check::invariants, "The emitted mesh is the datapath's own, bit for bit, and closed, without T-vertices");
        key.add("allowed_flips", &Check::allowed_flips, "percent of edges", between(0, 100), "Decisions that differ within the formats' error bound; more fail the run");
        key.add("allowed_triangles", &Check::allowed_triangles, "percent of triangles", between(0, 1000), "Largest difference in the number of triangles between golden's own run and the hardware; beyond it the run fails, as it does if three times that share of the points lies farther from the other surface than rounding explains. A run whose positions saturate is not judged by it. Raise it for thresholds finer than the formats");
        key.add("work", &Check::work, "No triangle is lost, doubled or altered on its way through the machine, and what goes into a unit comes out of another");
        key.add("reads", &Check::reads, "Every table read against what the memory holds; in functional mode reads then go by transaction, which is slow");
    });
    list.table("limits", &Job::limits, "Where a run gives up.", [](const auto& key) {
        using Limits = Job::Limits;
        key.add("cycles_without_progress", &Limits::cycles_without_progress, "cycles", between(1, any_count), "Timed mode: cycles in which units were at work and no triangle was decided or lit; more end the run with exit code 3");
        key.add("triangles", &Limits::triangles, "triangles", between(1, any_count), "Emitted triangles; more end the run with exit code 4");
    });
    list.table("output", &Job::output, "What a run writes.", [](const auto& key) {
        using Output = Job::Output;
        key.add("folder", &Output::folder, KeyKind::folder, "Folder of the run");
        key.add("ply", &Output::ply, "Write the mesh as binary PLY");
        key.add("obj", &Output::obj, "Write the mesh as OBJ too: text, some five times as large as mesh.ply");
        key.add("picture", &Output::picture, "Write picture.png");
        key.add("vcd", &Output::vcd, "Timed mode: write waveforms, trace.vcd; with several machines, of the first");
        key.add("timeline", &Output::timeline, "Timed mode: write activity per unit in the Chrome trace format, timeline.json; with several machines, of the first");
        key.add("trace_from", &Output::trace_from, "cycles", between(0, most_trace), "First cycle of waveforms and timeline");
        key.add("trace_to", &Output::trace_to, "cycles", between(0, most_trace), "Last cycle of waveforms and timeline");
        key.add("trace_units", &Output::trace_units, KeyKind::text, "Waveforms of those units only whose name contains one of these words; empty: all");
    });
    // clang-format on
    return list.take();
}

}  // namespace

std::string_view Key::leaf() const {
    const std::string_view whole = name;
    return whole.substr(whole.rfind('.') + 1);
}

const std::vector<KeyTable>& job_tables() {
    static const std::vector<KeyTable> tables = declare_keys();
    return tables;
}

const Key* find_key(std::string_view name) {
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys)
            if (key.name == name)
                return &key;
    }
    return nullptr;
}

const KeyTable* find_table(std::string_view name) {
    for (const KeyTable& table : job_tables())
        if (table.name == name)
            return &table;
    return nullptr;
}

JobValue default_of(const Key& key) {
    return key.get(Job{});
}

std::string automatic_key(const Job& job) {
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys)
            if (key.range.or_auto && key.get(job) == JobValue(std::string(auto_word)))
                return key.name;
    }
    return {};
}

bool same_settings(const Job& a, const Job& b) {
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys) {
            // As text, so that -0.0 differs from 0.0.
            if (toml_value(key.get(a)) != toml_value(key.get(b)))
                return false;
        }
    }
    return true;
}

}  // namespace tessera
