#include "modules/unit/unit.h"

namespace tessera {

std::string count_of(std::size_t count, const char* what) {
    if (count == 0)
        return {};
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace tessera
