#pragma once
#include "testbench/output/picture/image.h"

namespace tessera {

/// A picture for a PNG file and, if requested, the same in linear light for an EXR file.
struct Picture {
    Image image;
    LinearImage linear;          ///< empty if not requested
    bool mesh_in_sight = false;  ///< false: no part of the mesh is in the picture
};

/// Wraps an image that was not rendered, with its linear light if requested.
Picture to_picture(Image image, bool linear);

/// Copies `from` into `to` with its upper left corner at (left, top), clipped to `to`. `to` has the mesh in sight if
/// `from` has.
void paste(const Picture& from, int left, int top, Picture& to);

}  // namespace tessera
