#pragma once
#include <cstdint>

#include "modules/stream/work.h"

namespace tessera {

/// The item a unit has begun on last, as a timeline names it.
struct Begun {
    std::uint64_t count = 0;     ///< items the unit has begun on; 0: it names none
    std::uint32_t triangle = 0;  ///< number of the pass
    std::uint32_t base = 0;      ///< index of the base triangle
    Parts part = 0;              ///< the one part; 0: the whole triangle

    static Begun of(std::uint64_t count, const Work& work) {
        if (work.pass == nullptr)
            return {count};
        return {count, work.pass->number, work.pass->triangle.base, work.parts};
    }
};

}  // namespace tessera
