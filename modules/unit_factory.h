#pragma once
#include <memory>

#include "modules/memories/off_chip_memory.h"
#include "modules/memories/table_cache.h"
#include "modules/memories/table_memory.h"
#include "modules/sockets/memory_port.h"
#include "modules/timing/design.h"
#include "modules/units/calculate_new_p.h"
#include "modules/units/displace_vertex.h"
#include "modules/units/edge_tests/calculate_new_u.h"
#include "modules/units/edge_tests/collect_tests.h"
#include "modules/units/edge_tests/height_test.h"
#include "modules/units/edge_tests/normal.h"
#include "modules/units/edge_tests/sequence_tests.h"
#include "modules/units/edge_tests/tex_coord.h"
#include "modules/units/edge_tests/view.h"
#include "modules/units/families/pass_or_tessellate.h"
#include "modules/units/families/sequence_tests.h"
#include "modules/units/families/tessellation.h"
#include "modules/units/get_triangle.h"
#include "modules/units/lighting.h"
#include "modules/units/pass_or_tessellate.h"
#include "modules/units/tessellation.h"
#include "modules/units/transform.h"
#include "modules/units/triangle_queue.h"

namespace tessera {

/// Makes a machine's units. Override a function to replace a unit by a variant: a class derived from the unit, with its
/// sockets (modules/README.md, "How to replace a unit"). A variant may also be the same unit with another context, for
/// example with stalls for that unit only. Called during elaboration only.
class UnitFactory {
  public:
    UnitFactory() = default;
    virtual ~UnitFactory() = default;
    UnitFactory(const UnitFactory&) = delete;
    UnitFactory& operator=(const UnitFactory&) = delete;

    using Name = const sc_core::sc_module_name&;
    virtual std::unique_ptr<GetTriangle> get_triangle(Name name, const UnitContext& context) {
        return std::make_unique<GetTriangle>(name, context);
    }
    virtual std::unique_ptr<CalculateNewP> calculate_new_p(Name name, const UnitContext& context) {
        return std::make_unique<CalculateNewP>(name, context);
    }
    virtual std::unique_ptr<DisplaceVertex> displace_vertex(Name name, const UnitContext& context) {
        return std::make_unique<DisplaceVertex>(name, context);
    }
    virtual std::unique_ptr<Transform> transform(Name name, const UnitContext& context) {
        return std::make_unique<Transform>(name, context);
    }
    virtual std::unique_ptr<CalculateNewU> calculate_new_u(Name name, const UnitContext& context) {
        return std::make_unique<CalculateNewU>(name, context);
    }
    virtual std::unique_ptr<TexCoordTest> tex_coord_test(Name name, const UnitContext& context) {
        return std::make_unique<TexCoordTest>(name, context);
    }
    /// The Summed Height Test, or the design's test in its place (datapath::Formats::height_test).
    virtual std::unique_ptr<HeightTestUnit> height_test(Name name, const UnitContext& context) {
        return std::make_unique<HeightTestUnit>(name, context);
    }
    virtual std::unique_ptr<NormalTest> normal_test(Name name, const UnitContext& context, Parts takes) {
        return std::make_unique<NormalTest>(name, context, takes);
    }
    virtual std::unique_ptr<ViewTest> view_test(Name name, const UnitContext& context, Parts takes) {
        return std::make_unique<ViewTest>(name, context, takes);
    }
    virtual std::unique_ptr<CollectTests> collect_tests(Name name, const UnitContext& context) {
        return std::make_unique<CollectTests>(name, context);
    }
    virtual std::unique_ptr<SequenceTests> sequence_tests(Name name, const UnitContext& context) {
        return std::make_unique<SequenceTests>(name, context);
    }
    virtual std::unique_ptr<PassOrTessellate> pass_or_tessellate(Name name, const UnitContext& context) {
        return std::make_unique<PassOrTessellate>(name, context);
    }
    virtual std::unique_ptr<Tessellation> tessellation(Name name, const UnitContext& context) {
        return std::make_unique<Tessellation>(name, context);
    }
    /// In the family design.
    virtual std::unique_ptr<FamilyPassOrTessellate> family_pass_or_tessellate(Name name, const UnitContext& context) {
        return std::make_unique<FamilyPassOrTessellate>(name, context);
    }
    virtual std::unique_ptr<FamilySequenceTests> family_sequence_tests(Name name, const UnitContext& context) {
        return std::make_unique<FamilySequenceTests>(name, context);
    }
    virtual std::unique_ptr<FamilyTessellation> family_tessellation(Name name, const UnitContext& context) {
        return std::make_unique<FamilyTessellation>(name, context);
    }
    virtual std::unique_ptr<TriangleQueue> triangle_queue(Name name, const UnitContext& context) {
        return std::make_unique<TriangleQueue>(name, context);
    }
    virtual std::unique_ptr<Lighting> lighting(Name name, const UnitContext& context) {
        return std::make_unique<Lighting>(name, context);
    }

    /// Called with each module that has outputs, before they are bound. Override to interpose on its streams
    /// (StreamOutput).
    virtual void made(sc_core::sc_module& /*module*/) {}

    /// Joins a unit's port to its memory. The two sides of a dual-port displacement map count as two memories.
    virtual void join(MemoryPort& port, TableMemory& memory) { port.bind(memory); }
    virtual void join(MemoryPort& port, TableCache& cache) { port.bind(cache); }
    virtual void join(MemoryPort& port, OffChipMemory& memory) { port.bind(memory); }
};

}  // namespace tessera
