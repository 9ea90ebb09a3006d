#include <cmath>
#include <string>

#include "testbench/bake/bake.h"
#include "testbench/bake/surface_file.h"
#include "testbench/common/error.h"
#include "testbench/prove/fuzz/fuzz_target.h"

namespace tessera::fuzz {

void check_surface(std::string_view bytes) {
    constexpr int width = 5, height = 3;
    const std::string name = "fuzzed.toml";
    try {
        const BakedMap map = bake_heights(parse_surface(bytes, name), width, height);
        promise(map.width == width && map.height == height && map.values.size() == std::size_t{width} * height,
                "the baked map has another size");
        for (const double value : map.values)
            promise(std::isfinite(value), "a baked height is not finite");
    } catch (const InputError& error) {
        promise_message(error.what(), name);
    }
}

}  // namespace tessera::fuzz
