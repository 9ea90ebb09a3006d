#pragma once

namespace tessera {

/// When an edge's tests are evaluated.
enum class TestOrder {
    parallel,     ///< the paper's: all at once
    cheap_first,  ///< those without a table first; the others only if the decision still depends on them
};

}  // namespace tessera
