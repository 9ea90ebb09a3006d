#pragma once

namespace tessera {

/// Under a sanitizer memory and time are not representative.
constexpr bool sanitized =
#ifdef TESSERA_SANITIZE
    true;
#else
    false;
#endif

}  // namespace tessera
