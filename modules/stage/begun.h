#pragma once
#include <cstdint>

#include "modules/sockets/parts.h"

namespace tessera {

/// The item a unit has begun on last, as a timeline names it.
struct Begun {
    std::uint64_t count = 0;  ///< items the unit has begun on; 0: it names none
    Origin triangle;
    Parts parts = all_parts;  ///< the one part, or all: the whole triangle
};

}  // namespace tessera
