#pragma once
#include <cstddef>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"

namespace tessera {

/// Inputs of the unit that joins a triangle with its parts: Pass or Tessellate, in the family design Tessellation.
class JoiningUnit {
  public:
    StreamInput<TakenTriangle> from_get_triangle{"from_get_triangle"};
    StreamInput<ScreenPoint> from_transform{"from_transform"};

    virtual ~JoiningUnit() = default;

    /// Most triangles that waited for their first part.
    virtual std::size_t most_ahead_of_parts() const = 0;
};

}  // namespace tessera
