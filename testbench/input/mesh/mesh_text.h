#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

// What the readers of mesh files written as text have in common.

/// A piece of the file for a message: printable, short.
std::string quoted(std::string_view token);

/// What other kind of mesh file this is, by its content: "a PLY file"; empty: none that is known.
std::string_view foreign_mesh_kind(std::string_view content);

/// Locale-independent, correctly rounded; nothing where the token is not a number from end to end. Beyond a double's
/// range: 0 or HUGE_VAL.
std::optional<double> to_number(std::string_view token);

/// The whole file of mesh.file. `kind` says what it should be, as in "an OBJ file". Throws InputError if it cannot be
/// read or is no regular file, ResourceError beyond largest_mesh_file.
std::string read_mesh_text(std::string const& path, std::string_view kind);

}  // namespace tessera
