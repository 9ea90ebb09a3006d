#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// The polygon data of a Wavefront OBJ text, checked but not yet interpreted.
struct ObjText {
    static constexpr std::uint32_t none = UINT32_MAX;

    struct Corner {  ///< indices into the three lists below, from 0; `none` if absent in the file
        std::uint32_t position = none, texture = none, normal = none;
    };
    struct Face {  ///< corners[first .. first + count)
        std::size_t first = 0;
        std::uint32_t count = 0;  ///< at least 3
        std::size_t line = 0;     ///< the statement's first line, from 1
    };

    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec2> textures;
    std::vector<glm::dvec3> normals;
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<std::string> repairs;  ///< one sentence each
};

/// Reads the `v`, `vt`, `vn` and `f` (formerly `fo`) statements of an OBJ text: indices from 1 or negative from the
/// end, also of later vertices; UTF-8 byte order mark, LF, CRLF, CR, `\` at a line's end, comments. Groups, materials,
/// lines and points are skipped; other words are skipped with a repair that counts them.
///
/// Errors: "name:line: problem, value, remedy". InputError for anything that is not a finite number of single precision
/// or an existing index, a face of fewer than three corners, UTF-16 text or a zero byte, another mesh file format, a
/// file without faces; ResourceError beyond the limits of mesh_limits.h.
///
/// tinyobjloader is not used: it reads `nan`, `abc` and `0,5` as 0, `1.5` and `4294967297` as index 1, so that every
/// word would have to be checked beforehand, and the last digits of its numbers are inexact, which changed the
/// machine's result for two of 25 public meshes. The tests compare with it on valid files.
ObjText read_obj_text(std::string_view text, const std::string& name);

}  // namespace tessera
