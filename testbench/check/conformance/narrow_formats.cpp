#include "testbench/check/conformance/narrow_formats.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "testbench/job/job_keys.h"

namespace tessera {

std::string narrow_formats_warning(const Job& job) {
    std::vector<std::string> wider;
    // Texture coordinates and heights are rounded in golden's run, too.
    for (const char* name : {"formats.position_bits", "formats.position_fraction", "formats.normal_bits",
                             "formats.normal_fraction", "formats.screen_bits", "formats.screen_fraction"}) {
        const Key& key = *find_key(name);
        const auto usual = std::get<std::int64_t>(default_of(key));
        if (std::get<std::int64_t>(key.get(job)) < usual)
            wider.push_back(fmt::format("{} = {}", name, usual));
    }
    if (wider.empty())
        return {};
    return fmt::format(
        "the mesh or its decisions differ from the golden model's, whose positions and normals are not rounded, and "
        "formats are narrow: set {}",
        fmt::join(wider, " and "));
}

}  // namespace tessera
