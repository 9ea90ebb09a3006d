#pragma once
#include "testbench/output/picture/image.h"

namespace tessera {

/// A picture for a PNG file and, if it was asked for, what an EXR file needs: the same in linear light.
struct Picture {
    Image image;
    LinearImage linear;          ///< empty: not asked for
    bool mesh_in_sight = false;  ///< false: no part of the mesh is in the picture
};

/// An image that was not rendered, with its linear light if asked for.
Picture to_picture(Image image, bool linear);

/// Copies `from` into `to` with its upper left corner at (left, top); cut off where it does not fit. What is
/// in sight there is in sight here.
void paste(const Picture& from, int left, int top, Picture& to);

}  // namespace tessera
