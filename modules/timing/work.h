#pragma once

namespace tessera {

/// What goes round through the Triangle Queue.
enum class Work {
    triangle,  ///< the paper's: each triangle, to be tested or to be finished
    family,    ///< triangles that are known to split; their children are tested before they go round
};

}  // namespace tessera
