#include <cstdio>

#include "modules/datapath/displace.h"
#include "modules/datapath/midpoint.h"
#include "modules/version.h"

using namespace tessera::datapath;

// Computes the displaced midpoint of an edge with the machine's arithmetic alone.
int main() {
    const Formats formats;
    const DisplacementParameters displacement{1 << formats.position.fraction, 0};
    constexpr std::uint32_t half = 1u << 15;
    Saturations saturations;
    const Position middle = midpoint(Position{0, 0, 0}, Position{1 << 16, 0, 0});
    const Position displaced = displace(middle, Direction{0, 0, 1 << 14}, half, displacement, formats, saturations);
    std::printf("tessera %s: (%d, %d, %d) / 65536\n", tessera::version, displaced.x, displaced.y, displaced.z);
    return displaced == Position{1 << 15, 0, 1 << 15} ? 0 : 1;
}
