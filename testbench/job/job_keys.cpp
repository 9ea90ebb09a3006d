#include "testbench/job/job_keys.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <type_traits>
#include <utility>

#include "modules/timing/design_keys.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/toml_text.h"
#include "testbench/setup/setting_keys.h"

namespace tessera {

namespace {

constexpr double any_count = 2147483647;
constexpr double most_trace = 9e15;  // cycles; whole numbers a double holds

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

template <typename Enum>
std::vector<std::string_view> only(std::initializer_list<Enum> values) {
    std::vector<std::string_view> names;
    for (const Enum value : values)
        names.push_back(name_of(value));
    return names;
}

/// Fills one table; `Group` is the struct of Job whose members the keys set.
template <typename Group, typename Select>
class TableWriter {
  public:
    TableWriter(KeyTable& table, Select select) : table_(table), select_(select) {}

    void add(const char* leaf, bool Group::*member, const char* description) const {
        add_plain(leaf, member, KeyKind::flag, "-", {}, description);
    }
    Key& add(const char* leaf, std::int64_t Group::*member, const char* unit, KeyRange range,
             const char* description) const {
        return add_plain(leaf, member, KeyKind::integer, unit, range, description);
    }
    Key& add(const char* leaf, double Group::*member, const char* unit, KeyRange range,
             const std::string& description) const {
        return add_plain(leaf, member, KeyKind::number, unit, range, description);
    }
    void add(const char* leaf, std::array<double, 3> Group::*member, const char* unit, KeyRange range,
             const char* description) const {
        add_plain(leaf, member, KeyKind::vector, unit, range, description);
    }
    Key& add(const char* leaf, std::string Group::*member, KeyKind kind, const char* description) const {
        return add_plain(leaf, member, kind, "-", {}, description);
    }
    void add(const char* leaf, std::vector<double> Group::*member, const char* unit, const char* description) const {
        add_plain(leaf, member, KeyKind::numbers, unit, {}, description);
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
    template <typename Enum, typename Owner, typename = std::enable_if_t<std::is_enum_v<Enum>>>
    void add(const char* leaf, Enum Owner::*member, const std::string& description) const {
        add_choice<Enum>(
            leaf, [member](auto& group) -> auto& { return group.*member; }, description);
    }

    /// One of an enumeration's values: `member(group)` is a reference to it.
    template <typename Enum, typename Member>
    void add_choice(const DesignName& name, Member member, const std::string& description) const {
        Key& key = push(name.key, KeyKind::choice, "-", description);
        key.choices = names_of<Enum>();
        key.get = [select = select_, member](const Job& job) { return std::string(name_of(member(select(job)))); };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            const std::vector<std::string_view> names = names_of<Enum>();
            const auto found = std::find(names.begin(), names.end(), std::get<std::string>(value));
            member(select(job)) = static_cast<Enum>(found - names.begin());
        };
    }

    /// A flag deep within the group.
    template <typename Member>
    void add_switch(const DesignName& name, Member member, const std::string& description) const {
        Key& key = push(name.key, KeyKind::flag, "-", description);
        key.get = [select = select_, member](const Job& job) { return member(select(job)); };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            member(select(job)) = std::get<bool>(value);
        };
    }

    /// An unsigned or std::uint64_t number deep within the group: `member(group)` is a reference to it.
    template <typename Member>
    void add_number(const DesignName& name, Member member, const char* unit, DesignRange range,
                    const std::string& description) const {
        Key& key = push(name.key, KeyKind::integer, unit, description);
        key.range = between(range.least, range.most);
        key.get = [select = select_, member](const Job& job) { return static_cast<std::int64_t>(member(select(job))); };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            auto& it = member(select(job));
            it = static_cast<std::remove_reference_t<decltype(it)>>(std::get<std::int64_t>(value));
        };
    }

    /// A number deep within the group: `member(group)` is a reference to it, or, if the group is const, its value.
    template <typename Member>
    void add_double(const char* leaf, Member member, const char* unit, KeyRange range,
                    const std::string& description) const {
        add_value<double>(leaf, member, KeyKind::number, unit, range, description);
    }

  private:
    template <typename T>
    Key& add_plain(const char* leaf, T Group::*member, KeyKind kind, const char* unit, KeyRange range,
                   const std::string& description) const {
        return add_value<T>(
            leaf, [member](auto& group) -> auto& { return group.*member; }, kind, unit, range, description);
    }

    template <typename T, typename Member>
    Key& add_value(const char* leaf, Member member, KeyKind kind, const char* unit, KeyRange range,
                   const std::string& description) const {
        Key& key = push(leaf, kind, unit, description);
        key.range = range;
        key.get = [select = select_, member, range](const Job& job) {
            return value_or_auto<T>(member(select(job)), range);
        };
        key.set = [select = select_, member](Job& job, const JobValue& value) {
            member(select(job)) = from_value<T>(value);
        };
        return key;
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
        key.add("mode", &Job::mode, "functional: all results except cycle counts and the triangle queue's level, fastest; timed: cycle-accurate");
    });
    list.table("mesh", &Job::mesh, "The base mesh.", [](const auto& key) {
        using Mesh = Job::Mesh;
        key.add("source", &Mesh::source, "A built-in shape; file, run: the mesh in mesh.file (file is the default if mesh.file is given); lattice: a plane whose vertices lie at centres of texels, mesh.spacing apart, from the first texel's. On a clamped axis of n texels it ends at the last one's centre if mesh.spacing divides n - 1, on a repeated axis a period later if it divides n, else beyond that");
        key.add("file", &Mesh::file, KeyKind::file, "With mesh.source = \"file\" an OBJ file; with \"run\" the folder of an earlier run");
        key.add("fingerprint", &Mesh::fingerprint, KeyKind::text, "64-bit FNV-1a hash of the file (of a run's mesh.ply), 16 hexadecimal digits; a file with another hash is refused. A run writes it into its job.toml; empty: any file");
        key.add("columns", &Mesh::columns, "quads", between(0, 2048), "Quads along u of a plane, cylinder or sphere; 0: 3 for the plane, 32 for cylinder and sphere, which need 3 or more").sources = only({MeshSource::plane, MeshSource::cylinder, MeshSource::sphere});
        key.add("rows", &Mesh::rows, "quads", between(0, 2048), "Quads along v, likewise; a sphere needs 2 or more").sources = only({MeshSource::plane, MeshSource::cylinder, MeshSource::sphere});
        key.add("spacing", &Mesh::spacing, "texels", between(1, 2048), "Distance between the vertices of a lattice: a power of two").sources = only({MeshSource::lattice});
        key.add("width", &Mesh::width, "model units", length_range, "Size of the plane along x; with a lattice, of the map").sources = only({MeshSource::plane, MeshSource::lattice});
        key.add("depth", &Mesh::depth, "model units", length_range, "Size of the plane along y; with a lattice, of the map").sources = only({MeshSource::plane, MeshSource::lattice});
        key.add("radius", &Mesh::radius, "model units", length_range, "Radius of the cylinder or sphere").sources = only({MeshSource::cylinder, MeshSource::sphere});
        key.add("height", &Mesh::height, "model units", length_range, "Height of the cylinder").sources = only({MeshSource::cylinder});
    });
    list.table("map", &Job::map, "The displacement map.", [](const auto& key) {
        using Map = Job::Map;
        key.add("source", &Map::source, "A built-in map; file: the image in map.file (the default if map.file is given)");
        key.add("file", &Map::file, KeyKind::file, "EXR, PNG or PGM file, with map.source = \"file\"");
        key.add("fingerprint", &Map::fingerprint, KeyKind::text, "Hash of the file, as mesh.fingerprint");
        key.add("channel", &Map::channel, KeyKind::text, "Channel of an EXR file; empty: Y, else R, else the only one").sources = only({MapSource::file});
        key.add("width", &Map::width, "texels", between(1, 4096), "Width of a built-in map").sources = only({MapSource::half_donut, MapSource::text, MapSource::noise, MapSource::constant, MapSource::ramp});
        key.add("height", &Map::height, "texels", between(1, 4096), "Height of a built-in map").sources = only({MapSource::half_donut, MapSource::text, MapSource::noise, MapSource::constant, MapSource::ramp});
        key.add("value", &Map::value, "full scale", between(0, 1), "Value of the constant map").sources = only({MapSource::constant});
        key.add("seed", &Map::seed, "-", between(0, 4294967295.0), "Seed of the noise map").sources = only({MapSource::noise});
        key.add("text", &Map::text, KeyKind::text, "Text of the text map").sources = only({MapSource::text});
        key.add("range", &Map::range, "the map's own units", coordinate_range, "The range of map values that displacement.scale spans: full, all values that the source can represent (PGM: 0 to its maximum value; PNG: 0 to 255 or 65535; EXR and built-in maps: 0 to 1); data, from the lowest to the highest value that occurs; or [low, high]. Values outside the range extrapolate linearly. With data or [low, high] the displacement codes, and the full scale of tests.summed_height_threshold, span the values that occur");
        key.add("no_data", &Map::no_data, "the map's own units", "Values that mark missing data, such as -9999: their texels, like those that are NaN, get the lowest of the other values, and are counted. A value matches if it is the nearest of the file's type; one beyond 1e30, positive or negative, also if it differs by at most 1 %");
        key.add("heights", &Map::heights, "Contents of the displacement map: the map's heights, or heights fitted to the mesh that the job's thresholds give. They reduce its squared error at the texel centres most, lie within those of the texels up to two away, and do not enlarge the largest distance between mesh and map. The tables of the tests remain those of the map; errors are measured against it");
        key.add("address_u", &Map::address_u, "Addressing beyond the map's left and right border; repeat closes a cylinder's seam");
        key.add("address_v", &Map::address_v, "Addressing beyond the map's lower and upper border");
    });
    list.table("displacement", &Job::displacement, "From map value to height along the normal: bias + scale * (value - low) / (high - low), with low and high of map.range.", [](const auto& key) { declare_displacement_keys(key); });
    list.table("camera", &Job::camera, "The camera, which the View Test depends on.", [](const auto& key) { declare_camera_keys(key); });
    list.table("tests", &Job::tests, "The edge tests: split = (normal or summed_height or highlight) and view and tex_coord and generation.", [](const auto& key) { declare_tests_keys(key); });
    list.table("formats", &Job::formats, "Fixed-point formats of the hardware. The bits of signed formats include the sign.", [](const auto& key) { declare_formats_keys(key); });
    list.table("hardware", &Job::hardware, "The units' options.", [](const auto& key) {
        using Hardware = Job::Hardware;
        key.add("design", &Hardware::design, "Presets the keys of a design; each may be overridden. paper: the paper's; modern: a design that avoids its repeated work (modules/README.md, Designs); the mesh is the same");
        declare_scene_keys(key);
        declare_option_keys(key);
        key.add("machines", &Hardware::machines, "-", between(1, 16), "Number of complete machines, each with its own tables and off-chip memory; base triangle k goes to machine k modulo their number");
    });
    list.table("timing", &Job::timing, "Timed mode: the datasheet figures of every unit and memory.", [](const auto& key) {
        declare_timing_keys(key);
    });
    list.table("check", &Job::check, "What a run checks.", [](const auto& key) {
        using Check = Job::Check;
        key.add("golden", &Check::golden, "Compares every edge's decision with the golden model (scoreboard), and every register and table entry with the value that golden derives from the job independently");
        key.add("end_to_end", &Check::end_to_end, "Compares golden's own mesh of the whole job with the hardware's; also every register and table entry, as with check.golden");
        key.add("invariants", &Check::invariants, "Checks that the emitted mesh equals the bare datapath's, bit for bit, and is closed, without T-vertices");
        key.add("allowed_flips", &Check::allowed_flips, "percent of edges", between(0, 100), "Largest share of decisions that may differ within the formats' error bound; beyond it the run fails");
        key.add("allowed_triangles", &Check::allowed_triangles, "percent of triangles", between(0, 1000), "Largest difference in the number of triangles between golden's own run and the hardware; beyond it the run fails. It also fails if more than three times that share of the points lie farther from the other surface than rounding explains. Not applied to a run whose positions saturate. Raise it for thresholds finer than the formats");
        key.add("work", &Check::work, "Checks that no triangle is lost, duplicated or altered on its way through the machine, and that each unit receives what the unit before it sends");
        key.add("reads", &Check::reads, "Compares every table read with the memory's contents; in functional mode reads are then transactions, which is slow");
    });
    list.table("limits", &Job::limits, "Limits at which a run is stopped.", [](const auto& key) {
        using Limits = Job::Limits;
        key.add("cycles_without_progress", &Limits::cycles_without_progress, "cycles", between(1, any_count), "Timed mode: most consecutive cycles in which units work and no triangle is decided or lit; beyond it the run ends with exit code 3");
        key.add("triangles", &Limits::triangles, "triangles", between(1, any_count), "Most emitted triangles; beyond it the run ends with exit code 4");
    });
    list.table("output", &Job::output, "What a run writes.", [](const auto& key) {
        using Output = Job::Output;
        key.add("folder", &Output::folder, KeyKind::folder, "Folder of the run");
        key.add("ply", &Output::ply, "Write the mesh as binary PLY");
        key.add("obj", &Output::obj, "Also write the mesh as OBJ: text, about five times as large as mesh.ply");
        key.add("picture", &Output::picture, "Write picture.png");
        key.add("vcd", &Output::vcd, "Timed mode: write waveforms, trace.vcd; of several machines, the first");
        key.add("trace_from", &Output::trace_from, "cycles", between(0, most_trace), "First cycle of waveforms");
        key.add("trace_to", &Output::trace_to, "cycles", between(0, most_trace), "Last cycle of waveforms");
        key.add("trace_units", &Output::trace_units, KeyKind::text, "Waveforms only of units whose name contains one of these words; empty: all");
    });
    // clang-format on
    return list.take();
}

}  // namespace

std::string_view Key::leaf() const {
    const std::string_view whole = name;
    return whole.substr(whole.rfind('.') + 1);
}

bool Key::serves(Mode mode) const {
    return description.rfind(mode == Mode::timed ? "Functional mode" : "Timed mode", 0) != 0;
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
