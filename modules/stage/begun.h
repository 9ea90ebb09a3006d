#pragma once
#include <cstdint>

#include "modules/sockets/parts.h"

namespace tessera {

/// The item a unit began last, as the timeline names it.
struct Begun {
    std::uint64_t count = 0;  ///< items begun; 0: none is named
    Origin triangle;
    Parts parts = all_parts;  ///< the one part, or all: the whole triangle
};

}  // namespace tessera
