#pragma once
#include <cstddef>
#include <string>

namespace tessera {

/// All of it, unless nobody reads any more.
void write_to_pipe(int pipe, const void* data, std::size_t size);

/// All that is written until the other end is closed.
std::string read_from_pipe(int pipe);

}  // namespace tessera
