// libFuzzer's entry: one program per target; TESSERA_FUZZ_CHECK names its check.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "testbench/prove/fuzz/fuzz_target.h"

// The name is required by libFuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {  // NOLINT
    try {
        tessera::fuzz::TESSERA_FUZZ_CHECK({reinterpret_cast<const char*>(data), size});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fuzz: %s\n", error.what());
        std::abort();
    }
    return 0;
}
