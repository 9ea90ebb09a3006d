#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "modules/timing/design_options.h"
#include "modules/timing/timing.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

enum class MeshSource { plane, cylinder, sphere, file, run, lattice };
enum class MapSource { half_donut, text, noise, constant, ramp, file };
/// Contents of the displacement map: the map's heights, or heights fitted to the job's own mesh.
enum class MapHeights { given, fitted };
using Addressing = datapath::AddressMode;
using datapath::HeightTest;
using datapath::MapFilter;
using datapath::SummedHeightUnit;
using datapath::Triangulation;
enum class Mode { functional, timed };
enum class DesignPreset { paper, modern };

/// Whether mesh.file names a mesh of this source.
constexpr bool reads_file(MeshSource source) {
    return source == MeshSource::file || source == MeshSource::run;
}

/// The map values that displacement.scale spans.
struct MapRange {
    enum class Kind { full, data, given };
    Kind kind = Kind::full;
    double low = 0, high = 1;  // given: in the map's own units (HeightMap::source_units)
};

/// One run of tessera, as described by a job file. Every key's unit, default, range and description are declared once,
/// in job_keys.cpp, testbench/setup/setting_keys.h and modules/timing/design_keys.h. The defaults are the initialisers
/// below and form the default job (the half donut on the plane of 18 triangles, with vertices on whole texels). In it
/// the View, Tex Coord and Generation Tests alone stop 3,905, 9,992 and 270 edges; the last is a safeguard.
struct Job {
    struct Mesh {
        MeshSource source = MeshSource::plane;
        std::string file;           // OBJ file or a run's folder, depending on the source
        std::string fingerprint;    // of the file, see testbench/machine/fingerprint.h; empty: any
        std::int64_t columns = 0;   // quads along u; 0: the source's own (job_keys.cpp)
        std::int64_t rows = 0;      // quads along v; 0: likewise
        std::int64_t spacing = 64;  // lattice: texels
        double width = 2;           // plane: size along x; lattice: of the map
        double depth = 2;           // likewise along y
        double radius = 1;          // cylinder, sphere
        double height = 2;          // cylinder

        std::filesystem::path path;  // not a key: resolved path of `file` (job_paths.h); empty: none is read
    } mesh;

    struct Map {
        MapSource source = MapSource::half_donut;
        std::string file;          // EXR, PNG or PGM, with source = "file"
        std::string fingerprint;   // of the file; empty: any
        std::string channel;       // EXR channel; empty: Y, else R, else the only one
        std::int64_t width = 264;  // built-in maps, texels; a multiple of the plane's 3 quads
        std::int64_t height = 264;
        double value = 0.5;            // constant map, 0..1
        std::int64_t seed = 1;         // noise map
        std::string text = "tessera";  // text map
        MapRange range;
        std::vector<double> no_data;  // values that mark missing data, in the map's own units
        MapHeights heights = MapHeights::given;
        Addressing address_u = Addressing::clamp;
        Addressing address_v = Addressing::clamp;

        std::filesystem::path path;  // not a key, as above
    } map;

    using Displacement = DisplacementSettings;
    Displacement displacement;  // model units; automatic values: testbench/machine/resolve_job.h

    using Camera = CameraSettings;
    Camera camera;

    using Tests = TestSettings;
    Tests tests;

    using Formats = FormatSettings;
    Formats formats;

    struct Hardware : DesignOptions, SceneOptions {
        DesignPreset design = DesignPreset::paper;  // sets the keys of design_preset.h
        std::int64_t machines = 1;                  // side by side
    } hardware;

    Timing timing;  // timed mode: every unit's and memory's, see modules/timing/timing.h

    struct Check {
        bool golden = true;      // scoreboard: every edge against the golden model
        bool end_to_end = true;  // golden run of the whole mesh
        bool invariants = true;
        double allowed_flips = 0.5;    // percent of edges; more fails the run
        double allowed_triangles = 1;  // percent more or fewer in golden's own run; more fails the run
        bool work = true;              // no triangle is lost, duplicated or altered between units
        bool reads = false;            // every table read against the memory's contents
    } check;

    struct Limits {
        std::int64_t cycles_without_progress = 1000000;  // timed mode; more ends the run with exit code 3
        std::int64_t triangles = 20000000;               // emitted; more ends the run with exit code 4
    } limits;

    struct Output {
        std::string folder = "runs/half_donut";
        bool ply = true;
        bool obj = false;
        bool picture = true;
        bool vcd = false;               // timed mode: waveforms
        std::int64_t trace_from = 0;    // first cycle of waveforms
        std::int64_t trace_to = 10000;  // last cycle of waveforms
        std::string trace_units;        // only units whose name contains one of these words
    } output;

    Mode mode = Mode::timed;

    std::string folder;  // not a key: folder of the job file; empty: the current directory
};

}  // namespace tessera
