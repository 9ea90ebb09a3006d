#include "testbench/prove/random_machines/case_process.h"

#include <cstring>
#include <exception>
#include <string>
#include <type_traits>

#include "testbench/common/child_process.h"

namespace tessera {

namespace {

/// Figures and digest as they lie in memory, then the failure's text.
struct Header {
    CaseFigures figures;
    std::uint64_t mesh_digest;
};
static_assert(std::is_trivially_copyable_v<Header>);

}  // namespace

CaseResult run_case_in_process(const RandomCase& random_case, Mode mode) {
    const ChildEnd end = run_in_child([&] {
        CaseResult result;
        try {
            result = run_case(random_case, mode);
        } catch (const std::exception& error) {
            result.failure = error.what();
        }
        const Header header{result.figures, result.mesh_digest};
        return std::string(reinterpret_cast<const char*>(&header), sizeof header) + result.failure;
    });
    CaseResult result;
    if (!end.failure.empty() || end.told.size() < sizeof(Header)) {
        result.figures.runs = 1;
        result.failure = end.failure.empty() ? "ended without a result" : end.failure;
        return result;
    }
    Header header{};
    std::memcpy(&header, end.told.data(), sizeof header);
    result.figures = header.figures;
    result.mesh_digest = header.mesh_digest;
    result.failure = end.told.substr(sizeof header);
    return result;
}

}  // namespace tessera
