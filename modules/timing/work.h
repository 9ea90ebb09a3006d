#pragma once

namespace tessera {

/// The triangles that go through the Triangle Queue.
enum class Work {
    triangle,  ///< the paper's: each triangle, to be tested or finished
    family,    ///< only triangles that are known to split; children are tested before they enter the queue
};

}  // namespace tessera
