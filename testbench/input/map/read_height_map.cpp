#include "testbench/input/map/read_height_map.h"

#include <fmt/format.h>

#include <new>
#include <string_view>

#include "testbench/common/error.h"
#include "testbench/input/map/exr_reader.h"
#include "testbench/input/map/map_file.h"
#include "testbench/input/map/no_data.h"
#include "testbench/input/map/pgm_reader.h"
#include "testbench/input/map/png_reader.h"

namespace tessera {
namespace {

enum class Format { exr, png, pgm };

constexpr std::string_view format_name(Format format) {
    switch (format) {
        case Format::exr: return "EXR";
        case Format::png: return "PNG";
        case Format::pgm: return "PGM";
    }
    return "";
}

bool starts_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
    throw InputError(fmt::format("{}: {}", path.string(), why));
}

Format format_of_content(const std::filesystem::path& path, std::string_view start) {
    if (start.empty())
        refuse(path, "the map file is empty. Supply an EXR, PNG or PGM file.");
    if (starts_with(start, "\x76\x2f\x31\x01"))
        return Format::exr;
    if (starts_with(start, "\x89PNG\r\n\x1a\n"))
        return Format::png;
    if (start.size() >= 2 && start[0] == 'P' && start[1] >= '1' && start[1] <= '7') {
        if (start[1] == '2' || start[1] == '5')
            return Format::pgm;
        refuse(path, fmt::format("the map is a PNM file of kind {}; only greymaps P2 and P5 are read. Convert it, for "
                                 "example with pnmtopnm, pamtopnm or ppmtopgm.",
                                 start.substr(0, 2)));
    }
    if (starts_with(start, "version https://git-lfs"))
        refuse(path, "this is a Git LFS pointer, not the map itself. Fetch it with git lfs pull.");
    const std::string extension = lower_case_extension(path);
    const bool known = extension == ".exr" || extension == ".png" || extension == ".pgm";
    refuse(path, fmt::format("the map's first bytes, \"{}\", are not those of an EXR, PNG or PGM file{}. {}",
                             printable_ascii(start.substr(0, 16)),
                             known ? fmt::format(", though it is named {}", extension) : std::string(),
                             start[0] == '<' ? "It looks like a web page: download it again."
                                             : "Name another file, or convert this one."));
}

HeightMap read_format(Format format, const std::filesystem::path& path, const std::string& channel,
                      const std::vector<double>& no_data) {
    if (format == Format::exr)
        return read_exr(path, channel, no_data);
    HeightMap map = format == Format::png ? read_png(path) : read_pgm(path);
    if (!no_data.empty() && !replace_missing(map, no_data))
        refuse(path, fmt::format("all {} texels have a value in map.no_data; a map needs heights.", map.values.size()));
    return map;
}

}  // namespace

HeightMap read_height_map(const std::filesystem::path& path, const std::string& channel,
                          const std::vector<double>& no_data) {
    map_file_size(path);  // refuses anything but a regular file before opening it
    const Format format = format_of_content(path, map_file_start(path, 64));
    if (format != Format::exr && !channel.empty()) {
        refuse(path, fmt::format("map.channel = \"{}\", but this is a {} file; only EXR files have named "
                                 "channels. Leave map.channel empty.",
                                 printable_ascii(channel), format_name(format)));
    }
    HeightMap map;
    try {
        map = read_format(format, path, channel, no_data);
    } catch (const std::bad_alloc&) {
        throw ResourceError(fmt::format(
            "{}: there is not enough memory to read the map. Make the map smaller, or give the process more memory.",
            path.string()));
    }
    const std::string extension = lower_case_extension(path);
    for (const auto& [claimed, claimed_extension] :
         {std::pair{Format::exr, ".exr"}, {Format::png, ".png"}, {Format::pgm, ".pgm"}}) {
        if (claimed != format && extension == claimed_extension) {
            map.repairs.push_back(fmt::format("The file is named {} but is a {} file; it was read as such.", extension,
                                              format_name(format)));
        }
    }
    return map;
}

}  // namespace tessera
