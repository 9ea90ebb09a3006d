#include "testbench/prove/fuzz/memory_file.h"

#include <sys/mman.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace tessera::fuzz {

const std::filesystem::path& file_of(std::string_view bytes) {
    static const std::filesystem::path path = "/proc/self/fd/" + std::to_string(::memfd_create("fuzz", MFD_CLOEXEC));
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    if (!file.flush())
        throw std::runtime_error(path.string() + ": cannot be written");
    return path;
}

}  // namespace tessera::fuzz
