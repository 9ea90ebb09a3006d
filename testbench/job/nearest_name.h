#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// The name most likely meant by a mistyped one, by edit distance; empty if none is near. A key in a wrong table, or in
/// none, is near the key with the same last part.
std::string nearest_name(std::string_view mistyped, const std::vector<std::string>& names);

}  // namespace tessera
