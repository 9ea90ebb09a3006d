#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// What a Wavefront OBJ text says of polygons, checked but not yet interpreted.
struct ObjText {
    static constexpr std::uint32_t none = UINT32_MAX;

    struct Corner {  ///< indices into the three lists below, from 0; `none` where the file gives none
        std::uint32_t position = none, texture = none, normal = none;
    };
    struct Face {  ///< corners[first .. first + count)
        std::size_t first = 0;
        std::uint32_t count = 0;  ///< at least 3
        std::size_t line = 0;     ///< from 1; of the statement's first line
    };

    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec2> textures;
    std::vector<glm::dvec3> normals;
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<std::string> repairs;  ///< one sentence each
};

/// Reads OBJ text: v (x y z, with w or colours, which are checked and ignored), vt (u [v [w]]), vn, f and its
/// old name fo; indices from 1 or negative from the end, also of vertices that follow; UTF-8 byte order mark,
/// LF, CRLF, CR, `\` at a line's end, comments. Smoothing groups, materials, groups, lines and points are
/// skipped silently; free-form surfaces and words that are not OBJ are skipped with a repair that counts
/// them.
///
/// Errors: "name:line: what, the value, what to do". InputError for anything that is not a finite number or
/// an existing index, a coordinate beyond single precision, a face of fewer than three corners or of mixed
/// forms, UTF-16 text or a zero byte, no face at all; ResourceError beyond the limits of mesh_limits.h.
///
/// Why not tinyobjloader, which Debian keeps well: it reads `nan`, `abc` and `0,5` as 0, `1.5` as index 1,
/// skips empty faces, lets indices out of range pass with a warning that names the file's last line, loses
/// the first vertex behind a byte order mark, and refuses line continuation; its callbacks carry no line
/// number and its numbers are not correctly rounded. A checker in front of it would have to read every number
/// anyway. The tests use it as the second opinion on good files.
ObjText read_obj_text(std::string_view text, std::string const& name);

}  // namespace tessera
