#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// The name a mistyped one was most likely meant to be, by edit distance; empty if none is near. A name under
/// the wrong table (or none) is near the key of the same last part.
std::string nearest_name(std::string_view mistyped, const std::vector<std::string>& names);

}  // namespace tessera
