#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

// Functions shared by the readers of mesh files.

/// A token of the file for a message: printable, short.
std::string quoted(std::string_view token);

/// The kind of another mesh file format, detected by content, such as "a PLY file"; empty if unknown.
std::string_view foreign_mesh_kind(std::string_view content);

/// Locale-independent, correctly rounded; nothing if the token is not a number as a whole. Beyond a double's range: 0
/// or HUGE_VAL.
std::optional<double> to_number(std::string_view token);

/// Throws InputError if the mesh of this size is smaller than smallest_size. `name`: the file in the message.
void require_size(const glm::dvec3& size, const std::string& name);

/// The contents of mesh.file. `kind`: the expected kind, such as "an OBJ file". Throws InputError if it cannot be read
/// or is not a regular file, ResourceError beyond largest_mesh_file.
std::string read_mesh_text(const std::string& path, std::string_view kind);

}  // namespace tessera
