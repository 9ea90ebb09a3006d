#include "modules/units/transform.h"

#include "modules/datapath/transform.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

Transform::Transform(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().transform, context.design.transform_pipelines),
      to_join(context.design.work == Work::family ? "to_tessellation" : "to_pass_or_tessellate"),
      to_view_test("to_view_test", context.design.work == Work::family ? 0 : context.design.tests_units),
      registers_(context.registers) {
    takes_from(context, from_displace_vertex);
    delivers_to(context, to_join);
    const auto corner = +[](const ScreenPoint& point) { return ScreenCorner{point.tag, point.screen}; };
    for (StreamOutput<ScreenCorner>& output : to_view_test)
        delivers_to(context, output, corner, vertex_parts);
    multiplies(transform_multiplications(registers_.formats).add(transform_normal_multiplications(registers_.formats)));
}

ScreenPoint Transform::process(const DisplacedPoint& point, const Entries&) {
    const datapath::TransformParameters& parameters = registers_.transform;
    ScreenPoint result{point, {}};
    if (point.tag.is_normal()) {
        result.n = transform_normal(point.n, parameters, registers_.formats, saturations_);
        ++normals_;
    } else {
        result.screen = transform(point.displaced, parameters, registers_.formats, saturations_);
        ++positions_;
        if (registers_.formats.families) {
            if (point.tag.is_vertex())
                result.n = point.displaced_n;
            result.displaced_n = transform_normal(point.displaced_n, parameters, registers_.formats, saturations_);
            ++normals_;
        }
    }
    return result;
}

}  // namespace tessera
