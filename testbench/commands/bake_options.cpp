#include "testbench/commands/bake_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "testbench/commands/option_values.h"
#include "testbench/input/map/map_file.h"
#include "testbench/setup/height_map.h"

namespace tessera {

namespace {

MapFormat format_of(const std::filesystem::path& output) {
    const std::string ending = lower_case_extension(output);
    if (ending == ".pgm")
        return MapFormat::pgm;
    if (ending == ".png")
        return MapFormat::png;
    if (ending == ".exr")
        return MapFormat::exr;
    throw InputError(fmt::format("--output {}: maps are written as FILE.pgm, FILE.png (16 bit) or FILE.exr (float)",
                                 output.string()));
}

}  // namespace

void BakeOptions::add_to(CLI::App& bake) {
    bake.add_option("SURFACE", surface_, "surface file (TOML): [quadric], [nurbs] or [bezier]")->required();
    bake.add_option("--output", output_,
                    "the map, FILE.pgm or FILE.png (16 bit) or FILE.exr (float); FILE.job.toml is written beside it")
        ->required();
    bake.add_option("--size", size_, "WIDTHxHEIGHT of the map in texels; default: 256x256");
    mesh_given_ = bake.add_option(
        "--mesh", mesh_, "JOB with the base mesh along whose normals the surface is sampled; default: the plane z = 0");
}

BakeRequest BakeOptions::request() const {
    BakeRequest request;
    if (surface_.empty())
        throw InputError("SURFACE is empty: name a surface file");
    if (mesh_given_->count() > 0 && mesh_.empty())
        throw InputError("--mesh is empty: name a job file, or leave it out for the plane z = 0");
    request.surface = surface_;
    request.mesh_job = mesh_;
    request.output = output_;
    request.format = format_of(request.output);
    const std::size_t by = size_.find('x');
    request.width = parse_number(size_.substr(0, by));
    request.height = by == std::string::npos ? -1 : parse_number(size_.substr(by + 1));
    const auto allowed = [](int side) { return side >= 1 && side <= largest_map_side; };
    if (!allowed(request.width) || !allowed(request.height))
        throw InputError(
            fmt::format("--size {}: expected WIDTHxHEIGHT in texels, each from 1 to {}, as in --size 256x256", size_,
                        largest_map_side));
    return request;
}

}  // namespace tessera
