#pragma once
#include "testbench/render/image.h"

namespace tessera {

struct Picture {
    Image image;
    bool mesh_in_sight = false;  ///< false: no part of the mesh is in the picture
};

}  // namespace tessera
