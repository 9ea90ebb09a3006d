#pragma once
#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/cull.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/light.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/rectangle.h"
#include "modules/datapath/transform.h"
#include "modules/datapath/triangulate.h"

namespace tessera::datapath {

/// Calls visit(name of a function or group, struct of its intermediates) for each, in the order of README.md.
template <class Visit>
constexpr void visit_intermediates(const Formats& f, Visit&& visit) {
    visit("midpoint", MidpointWidths{f});
    visit("interpolate", BilinearWidths{f});
    visit("displace", DisplaceWidths{f});
    visit("normalise", NormaliseWidths(f, BumpWidths{f}.combined.bits));
    visit("reciprocal_root", ReciprocalRootWidths{f});
    visit("bump", BumpWidths{f});
    visit("transform", TransformWidths{f});
    visit("reciprocal", ReciprocalWidths{f});
    visit("transform_normal", TransformNormalWidths{f});
    visit("rectangle_size", RectangleWidths{f});
    visit("edge tests", EdgeTestWidths{f});
#define TESSERA_OF_HEIGHT_TEST(Test) Test::visit_intermediates(f, visit);
    TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_OF_HEIGHT_TEST)
#undef TESSERA_OF_HEIGHT_TEST
    visit("choose_second_diagonal", DiagonalWidths{f});
    visit("faces_away", CullWidths{f});
    visit("light", LightWidths{f});
}

}  // namespace tessera::datapath
