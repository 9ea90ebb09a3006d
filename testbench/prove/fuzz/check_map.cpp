#include <algorithm>
#include <cmath>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/prove/fuzz/fuzz_target.h"
#include "testbench/prove/fuzz/memory_file.h"

namespace tessera::fuzz {

namespace {

/// Checks the guarantees of height_map.h.
void promise_complete(const HeightMap& map) {
    promise(map.width >= 1 && map.width <= largest_map_side && map.height >= 1 && map.height <= largest_map_side,
            "a map's side is out of range");
    promise(map.values.size() == static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height),
            "the numbers of values and texels differ");
    promise(std::all_of(map.values.begin(), map.values.end(), [](float value) { return std::isfinite(value); }),
            "a value is not finite");
    const auto [lowest, highest] = map.extremes();
    promise(map.range_low <= lowest && highest <= map.range_high, "a value is beyond the map's range");
    promise(std::isfinite(map.range_low) && std::isfinite(map.range_high), "the map's range is not finite");
    promise(std::isfinite(map.source_units) && map.source_units >= 1, "the source's unit is not 1 or more");
    for (const std::string& repair : map.repairs)
        promise(!repair.empty() && repair.find('\n') == std::string::npos, "a repair is empty or longer than a line");
}

}  // namespace

void check_map(std::string_view bytes) {
    const std::filesystem::path& path = file_of(bytes);
    try {
        promise_complete(read_height_map(path));
    } catch (const InputError& error) {
        promise_message(error.what(), path.string());
    }
}

}  // namespace tessera::fuzz
