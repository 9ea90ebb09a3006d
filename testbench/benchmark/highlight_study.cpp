#include <fmt/core.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <systemc>

#include "testbench/benchmark/gouraud_error.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"

// Compares a job's meshes with lighting per vertex: without the Highlight Test, with it, and without it at a Normal
// Test threshold that gives as many triangles. Writes one Markdown table to standard output.
//
//     tessera_highlight_study [--data FOLDER] [JOB.toml] [TABLE.KEY=VALUE]...

namespace {

using namespace tessera;

struct Row {
    std::size_t triangles = 0;
    GouraudError error;
};

class Study {
  public:
    explicit Study(const Job& job)
        : mesh_(load_mesh(job)), map_(load_map(job)), job_(resolve_job(job, mesh_, map_).job) {
        const MachineSetup setup = setup_of(true, job_.tests.normal_threshold);
        const auto& half = setup.registers.tests.half_vector;
        highlight_.half_vector =
            glm::normalize(Dequantise(setup.registers.formats).direction({half[0], half[1], half[2]}));
        highlight_.angle = job_.tests.highlight_angle;
    }

    Row run(bool highlight_test, double normal_threshold) const {
        const MachineSetup setup = setup_of(highlight_test, normal_threshold);
        BareRecursion bare(setup);
        EmittedMesh mesh;
        bare.run(mesh);
        return {mesh.triangles.size(), measure_gouraud(mesh, setup, GoldenInputs(setup), highlight_)};
    }

    /// Returns the largest Normal Test threshold found that gives at least `triangles` triangles without a Highlight
    /// Test, or nearly 0 if none does because the other tests allow no more.
    double threshold_for(std::size_t triangles) const {
        double low = 0, high = job_.tests.normal_threshold;
        for (int step = 0; step < 16; ++step) {
            const double middle = (low + high) / 2;
            (run(false, middle).triangles >= triangles ? low : high) = middle;
        }
        return low;
    }

    const Job& job() const { return job_; }
    int exponent() const { return highlight_.exponent; }

  private:
    MachineSetup setup_of(bool highlight_test, double normal_threshold) const {
        Job job = job_;
        job.tests.highlight = highlight_test;
        job.tests.normal_threshold = normal_threshold;
        return make_setup(job, mesh_, map_);
    }

    BaseMesh mesh_;
    HeightMap map_;
    Job job_;
    Highlight highlight_;
};

void print_row(const char* what, double threshold, const Row& row) {
    const GouraudError& e = row.error;
    fmt::print("| {} | {:.4f} | {} | {:.4f} | {:.4f} | {:.4f} | {:.3f} | {:.3f} |\n", what, threshold, row.triangles,
               e.rms, e.highlight_rms, e.largest, e.highlight_triangles, e.other_triangles);
}

void print_study(const Study& study) {
    const auto& tests = study.job().tests;
    const Row without = study.run(false, tests.normal_threshold);
    const Row with = study.run(true, tests.normal_threshold);
    const double finer = study.threshold_for(with.triangles);
    fmt::print(
        "Highlight within {} degrees of the half vector, normal threshold {}; specular exponent {}; errors of\n"
        "per-vertex against per-texel specular light, full scale 1; density in triangles per texel\n\n"
        "| Highlight Test | Normal Test threshold | triangles | RMS | RMS in the highlight | largest | "
        "density "
        "in it | elsewhere |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        tests.highlight_angle, tests.highlight_normal_threshold, study.exponent());
    print_row("off", tests.normal_threshold, without);
    print_row("on", tests.normal_threshold, with);
    const Row as_many = study.run(false, finer);
    const bool enough = as_many.triangles >= with.triangles;
    print_row(enough ? "off, same number of triangles" : "off, most triangles the other tests allow", finer, as_many);
}

Study make_study(int argc, char** argv) {
    Job job;
    std::filesystem::path data;
    for (int k = 1; k < argc; ++k) {
        const std::string argument = argv[k];
        if (argument == "--data" && k + 1 < argc)
            data = argv[++k];
        else if (argument.find('=') == std::string::npos)
            job = read_job(argument);
        else
            apply_setting(job, argument);
    }
    validate(job);
    resolve_paths(job, data);
    return Study(job);
}

}  // namespace

int sc_main(int argc, char** argv) {
    try {
        print_study(make_study(argc, argv));
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
    return 0;
}

int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return sc_core::sc_elab_and_sim(argc, argv);
}
