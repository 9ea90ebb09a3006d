#include "modules/units/edge_tests/height_test.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "modules/stage/stage_steps.h"
#include "modules/units/edge_tests/declared_reads.h"

namespace tessera {

HeightTestUnit::HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : HeightTestUnit(name, context, functions_of(context.registers.formats.height_test)) {}

HeightTestUnit::HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context,
                               const datapath::HeightTestFunctions& functions)
    : Stage(name, context, height_test_timing(context.timing(), context.registers.formats), 1,
            height_test_latency(context.design, context.registers.formats)),
      table(functions_of(context.registers.formats.height_test).table().c_str(),
            context.registers.height_table.entry_bytes, context.design.direct_memory),
      registers_(context.registers),
      functions_(functions) {
    takes_from(context, input);
    delivers_to(context, output);
    reads_through(table, functions.requests);
    if (functions.reads_codes(registers_.formats)) {
        displacement_map.emplace("displacement_map", registers_.displacement_map.entry_bytes,
                                 context.design.direct_memory);
        reads_through(*displacement_map, 1);
    }
    keeps(static_cast<int>(functions.requests) * functions.entry_bits(registers_.formats));
    multiplies(functions.multiplications(registers_));
}

void HeightTestUnit::reads(const HeightOperands& edge, Reads& reads) const {
    if (registers_.tests.summed_height_test) {
        functions_.reads(edge, registers_, reads);
        if (!as_declared(functions_, reads, registers_))
            SC_REPORT_ERROR("tessera/height_test",
                            (std::string(name()) + ": " + fault_of(functions_, reads, registers_)).c_str());
    }
}

HeightResult HeightTestUnit::process(const HeightOperands& edge, const Entries& entries) {
    const bool on = registers_.tests.summed_height_test;
    decision_ = {};
    if (on)
        functions_.decide(edge, entries, registers_, decision_);
    return {edge.tag, decision_.asks, decision_.rank};
}

void HeightTestUnit::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    const auto thresholds = functions_.thresholds(registers_.formats);
    for (std::size_t k = 0; k < thresholds.size(); ++k)
        if (const auto& [name, bits, is_signed, meaning] = thresholds[k]; bits > 0)
            signals.value(
                thresholds[1].name == nullptr ? "threshold" : name, static_cast<unsigned>(bits),
                static_cast<std::uint64_t>(registers_.tests.height_thresholds[k]) & ((std::uint64_t{1} << bits) - 1));
}

void HeightTestUnit::trace_processed(Signals& signals, const HeightOperands&, const HeightResult&) const {
    for (unsigned k = 0; k < functions_.traced(registers_.formats); ++k) {
        const auto& [value, bits] = functions_.values[k];
        if (bits < 64 && decision_.values[k] >> bits != 0)
            SC_REPORT_ERROR(
                "tessera/height_test",
                (std::string(name()) + ": height test " + functions_.name + ": the value " + value + " is " +
                 std::to_string(decision_.values[k]) + ", but " + std::to_string(bits) + " bits are declared")
                    .c_str());
        signals.value(value, bits, decision_.values[k]);
    }
}

}  // namespace tessera
