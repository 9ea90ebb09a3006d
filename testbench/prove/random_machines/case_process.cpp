#include "testbench/prove/random_machines/case_process.h"

#include <cstring>
#include <exception>
#include <string>
#include <type_traits>

#include "testbench/common/child_process.h"

namespace tessera {

/// A result as bytes: the figures' memory image, then the failure's text.
static_assert(std::is_trivially_copyable_v<CaseFigures>);

CaseResult run_case_in_process(const RandomCase& random_case, Mode mode) {
    const ChildEnd end = run_in_child([&] {
        CaseResult result;
        try {
            result = run_case(random_case, mode);
        } catch (const std::exception& error) {
            result.failure = error.what();
        }
        return std::string(reinterpret_cast<const char*>(&result.figures), sizeof result.figures) + result.failure;
    });
    CaseResult result;
    if (!end.failure.empty() || end.told.size() < sizeof result.figures) {
        result.figures.runs = 1;
        result.failure = end.failure.empty() ? "ended without a result" : end.failure;
        return result;
    }
    std::memcpy(&result.figures, end.told.data(), sizeof result.figures);
    result.failure = end.told.substr(sizeof result.figures);
    return result;
}

}  // namespace tessera
