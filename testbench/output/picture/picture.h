#pragma once
#include "testbench/output/picture/image.h"
#include "testbench/output/picture/linear_image.h"

namespace tessera {

/// A picture for a PNG file and, if it was asked for, what an EXR file needs: the same in linear light.
struct Picture {
    Image image;
    LinearImage linear;          ///< empty: not asked for
    bool mesh_in_sight = false;  ///< false: no part of the mesh is in the picture
};

/// A picture all of one colour.
Picture plain_picture(int width, int height, const Colour& colour, bool linear);

/// Copies `from` into `to` with its upper left corner at (left, top); cut off where it does not fit. What is
/// in sight there is in sight here.
void paste(const Picture& from, int left, int top, Picture& to);

/// Text and legends are drawn on the image alone. This takes them over into linear light: a pixel whose colour in the
/// image is not its linear light's gets the image's. Nothing to do without linear light.
void take_over_annotations(Picture& picture);

}  // namespace tessera
