#include "modules/conductor.h"

#include <algorithm>

#include "modules/schedule/machine.h"
#include "modules/schedule/stepped_machine.h"
#include "modules/sockets/parts.h"

namespace tessera {

namespace {

/// Passes between two returns to the kernel, so that a stop can take effect.
constexpr unsigned passes_between_waits = 1024;

schedule::PipelinePlan pipeline_plan(const UnitTiming& timing, unsigned servers = 1, unsigned further_stages = 0) {
    return {timing.latency, timing.interval, servers, register_stages(timing, servers, further_stages)};
}

/// The plans of a machine's inputs as in timed mode, where they have the same names.
class Inputs {
  public:
    explicit Inputs(const StallParameters& stalls) : stalls_(stalls) {}

    template <class Payload>
    schedule::InputPlan of(const StreamInput<Payload>& input) const {
        return {static_cast<unsigned>(input.depth()), RandomStalls(stalls_, input.name())};
    }
    schedule::InputPlan of(const TableMemory& memory, unsigned buffer) const {
        return {buffer, RandomStalls(stalls_, memory.name())};
    }

  private:
    StallParameters stalls_;
};

schedule::TablePlan table_plan(const schedule::InputPlan& input, const MemoryTiming& timing, unsigned entry_bytes,
                               unsigned under_way) {
    const unsigned slots = timing.width == 0 ? 1 : (entry_bytes + timing.width - 1) / timing.width;
    return {input, timing.ports, timing.banks, slots, timing.latency, timing.window, under_way};
}

std::unique_ptr<schedule::Timetable> make_schedule(const schedule::Plan& plan) {
    if (plan.tests_units > 1 || plan.heights_from_displacement_map)
        return std::make_unique<schedule::SteppedMachine>(plan);
    return std::make_unique<schedule::Machine>(plan);
}

}  // namespace

std::string Conductor::key_without_schedule(const Design& design, const datapath::Formats& formats) {
    const HeightTestKind& kind = kind_of(formats.height_test);
    if (design.work == Work::family)
        return "hardware.work";
    if (design.test_order == TestOrder::cheap_first)
        return "hardware.test_order";
    if (design.queue.capacity > 0)
        return "hardware.queue_capacity";
    const auto cached = [&](const MemoryTiming& table) { return table.cache.bytes > 0; };
    if (cached(design.timing.displacement_map))
        return "timing.displacement_map_cache_bytes";
    if (cached(design.timing.normal_map))
        return "timing.normal_map_cache_bytes";
    return cached(design.timing.*kind.table_timing) ? "timing." + std::string(kind.table) + "_cache_bytes" : "";
}

schedule::Plan Conductor::plan_of(Pipeline& machine, const Rasteriser& rasteriser, const Design& timed) {
    namespace s = schedule;
    const Timing& t = timed.timing;
    const datapath::Registers& registers = machine.registers();
    const datapath::Formats& formats = registers.formats;
    const HeightTestKind& kind = kind_of(formats.height_test);
    const Inputs inputs(t.stalls);
    PassOrTessellate& join = *machine.triangle_pass_or_tessellate;

    s::Plan plan;
    plan.source.from_host = inputs.of(machine.get_triangle.from_host);
    plan.source.from_triangle_queue = inputs.of(machine.get_triangle.from_triangle_queue);
    plan.source.from_tessellation = inputs.of(machine.triangle_queue.from_tessellation);
    plan.source.queue = pipeline_plan(t.triangle_queue);
    plan.source.newest_first = timed.queue.order == TriangleOrder::lifo;
    plan.source.watermark = std::max<std::uint64_t>(timed.queue.watermark, 1);
    plan.source.get_triangle = s::get_triangle;
    plan.get_triangle = pipeline_plan(t.get_triangle);
    plan.calculate_new_p = {inputs.of(machine.calculate_new_p.from_get_triangle), pipeline_plan(t.calculate_new_p)};
    plan.displace_vertex = {inputs.of(machine.displace_vertex.from_calculate_new_p),
                            pipeline_plan(t.displace_vertex, 1, displace_vertex_latency(timed))};
    plan.transform = {inputs.of(machine.transform.from_displace_vertex),
                      pipeline_plan(t.transform, timed.transform_pipelines)};
    UnitTiming normal_test = t.normal_test;
    if (registers.tests.highlight_test)
        normal_test.latency += t.highlight_test_latency;
    plan.tests_units = timed.tests_units;
    for (unsigned k = 0; k < plan.tests_units; ++k) {
        TessellationTests& tests = machine.tessellation_tests[k];
        plan.tests[k] = {
            {inputs.of(tests.calculate_new_u.input), pipeline_plan(t.calculate_new_u)},
            {inputs.of(tests.tex_coord_test.input), pipeline_plan(t.tex_coord_test)},
            {inputs.of(tests.height_test.input),
             pipeline_plan(t.*kind.unit_timing, 1, height_test_latency(timed, formats))},
            {inputs.of(tests.normal_test.input), pipeline_plan(normal_test, 1, t.read_latency(t.normal_map))},
            {inputs.of(tests.view_test.input), pipeline_plan(t.view_test)},
            inputs.of(*tests.view_test.from_transform),
            {inputs.of(tests.collect_tests->from_normal_test), inputs.of(tests.collect_tests->from_tex_coord_test),
             inputs.of(tests.collect_tests->from_summed_height_test), inputs.of(tests.collect_tests->from_view_test)},
            inputs.of(join.from_tessellation_tests[k])};
    }
    plan.join_triangles = inputs.of(join.from_get_triangle);
    plan.join_parts = inputs.of(join.from_transform);
    plan.join_places = t.pass_or_tessellate.buffer;
    plan.join = pipeline_plan(t.pass_or_tessellate);
    plan.tessellation_input = inputs.of(machine.triangle_tessellation->from_pass_or_tessellate);
    plan.tessellation = pipeline_plan(t.tessellation);
    plan.lighting = {inputs.of(machine.lighting.from_pass_or_tessellate), pipeline_plan(t.lighting)};
    plan.rasteriser = inputs.of(rasteriser.from_lighting);
    const auto displacement_map_plan = [&](const TableMemory& side, unsigned under_way) {
        return table_plan(inputs.of(side, t.displacement_map.buffer), t.displacement_map,
                          registers.displacement_map.entry_bytes, under_way);
    };
    const unsigned displaced = plan.displace_vertex.pipeline.stages + 1;
    const unsigned tested = plan.tests[0].height_test.pipeline.stages + 1;
    plan.heights_from_displacement_map = formats.codes;
    plan.displacement_map =
        displacement_map_plan(machine.displacement_map, std::max(displaced, formats.codes ? tested : 0));
    if (machine.displacement_map_for_tests != nullptr)
        plan.displacement_map_for_tests = displacement_map_plan(*machine.displacement_map_for_tests, tested);
    plan.normal_map = table_plan(inputs.of(machine.normal_map, t.normal_map.buffer), t.normal_map,
                                 registers.normal_map.entry_bytes, plan.tests[0].normal_test.pipeline.stages + 1);
    plan.height_table =
        table_plan(inputs.of(machine.height_table, (t.*kind.table_timing).buffer), t.*kind.table_timing,
                   registers.height_table.entry_bytes, kind.requests * plan.tests[0].height_test.pipeline.stages + 1);
    return plan;
}

void Conductor::ReadFacts::read(unsigned part, const Reads& reads) {
    schedule::PartReads& facts = parts_[part];
    const unsigned requests = reads.requests();
    facts.requests = static_cast<std::uint8_t>(requests);
    if (requests == 0)
        return;
    facts.memory = static_cast<std::uint8_t>(reads.port(0));
    for (unsigned k = 0; k < requests; ++k)
        facts.first[k] = static_cast<std::uint8_t>(reads.first(k));
    facts.first[requests] = static_cast<std::uint8_t>(reads.entries());
    const BankOfEntry& bank_of = memories_[facts.memory];
    if (!bank_of.several())
        return;
    for (unsigned k = 0; k < reads.entries(); ++k)
        facts.banks[k] = static_cast<std::uint8_t>(bank_of(reads.addresses()[k]));
}

Conductor::Conductor(const sc_core::sc_module_name& name, Pipeline& machine, Host& host, const Rasteriser& rasteriser,
                     const Design& timed)
    : sc_module(name),
      machine_(machine),
      host_(host),
      schedule_(make_schedule(plan_of(machine, rasteriser, timed))),
      vertices_(facts_.displace_vertex,
                {BankOfEntry(timed.timing.displacement_map, machine.registers().displacement_map)}),
      heights_(facts_.height_test,
               {BankOfEntry(timed.timing.*kind_of(machine.registers().formats.height_test).table_timing,
                            machine.registers().height_table),
                BankOfEntry(timed.timing.displacement_map, machine.registers().displacement_map)}),
      normals_(facts_.normal_test, {BankOfEntry(timed.timing.normal_map, machine.registers().normal_map)}) {
    machine.displace_vertex.observe_reads(&vertices_);
    units_ = {&machine.get_triangle,
              &machine.calculate_new_p,
              &machine.displace_vertex,
              &machine.transform,
              &machine.pass_or_tessellate,
              &machine.tessellation,
              &machine.triangle_queue,
              &machine.lighting,
              &machine.displacement_map,
              machine.displacement_map_for_tests.get(),
              &machine.normal_map,
              &machine.height_table,
              nullptr};
    for (TessellationTests& tests : machine.tessellation_tests) {
        tests.height_test.observe_reads(&heights_);
        tests.normal_test.observe_reads(&normals_);
        units_.insert(units_.end(), {&tests.calculate_new_u, &tests.tex_coord_test, &tests.height_test,
                                     &tests.normal_test, &tests.view_test, tests.collect_tests});
    }
    consumers_.assign(units_.begin(), units_.end());
    consumers_[schedule::rasteriser] = &rasteriser;
    SC_HAS_PROCESS(Conductor);
    SC_THREAD(conduct);
}

void Conductor::send(const schedule::Source::Next& next) {
    using Way = schedule::Way;
    const DecidingUnit::Counts& counts = machine_.pass_or_tessellate.counts();
    const std::uint64_t culled = counts.culled;
    const datapath::Triangle& triangle = next.from_host ? host_.next() : machine_.triangle_queue.kept(next.place);
    facts_.parts = parts_of(triangle);
    facts_.tested = !triangle.finished;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    if (next.from_host)
        host_.send_next(delay);
    else
        machine_.triangle_queue.send(next.place, delay);
    const TriangleQueue::Arrived arrived = machine_.triangle_queue.take_arrived();
    facts_.children = arrived.count;
    facts_.place = arrived.place;
    facts_.way = arrived.count > 0 ? Way::tessellation : counts.culled > culled ? Way::dropped : Way::lighting;
}

void Conductor::conduct() {
    for (;;) {
        machine_.begin_frame();
        schedule_->send(host_.total() - host_.sent(), schedule_->last());
        for (unsigned passes = 1;; ++passes) {
            const schedule::Source::Next& next = schedule_->next();
            if (!next.any)
                break;
            send(next);
            schedule_->pass(facts_);
            if (passes % passes_between_waits == 0)
                wait(sc_core::SC_ZERO_TIME);
        }
        machine_.end_frame();
        wait(host_.again());
    }
}

void Conductor::observe(const Unit& unit, schedule::ItemObserver* observer) {
    const auto found = std::find(units_.begin(), units_.end(), &unit);
    if (found != units_.end())
        schedule_->observe(static_cast<schedule::Unit>(found - units_.begin()), observer);
}

void Conductor::finish(std::uint64_t cycles) {
    schedule_->finish(cycles);
    for (std::size_t k = 0; k < units_.size(); ++k) {
        if (units_[k] == nullptr)
            continue;
        const schedule::Figures its = schedule_->figures(static_cast<schedule::Unit>(k));
        Activity::Figures figures;
        figures.items = its.items;
        figures.high_water_mark = its.most;
        figures.item_cycles = its.item_cycles;
        for (std::size_t state = 0; state < states; ++state)
            figures.cycles[state] = its.states->cycles_in(static_cast<State>(state));
        for (std::size_t share = 0; share < schedule::States::most_shares; ++share) {
            const schedule::States::Share& of = its.states->shares()[share];
            if (of.by != schedule::nobody)
                figures.shares[share] = {of.state, consumers_[of.by], of.cycles};
        }
        units_[k]->activity().assign(figures);
    }
    const auto assign = [&](TableMemory& memory, schedule::Unit unit) {
        const schedule::Ports& its = schedule_->ports(unit);
        memory.assign({its.bank_slots(), its.entries(), its.held_up()});
    };
    assign(machine_.displacement_map, schedule::displacement_map);
    if (machine_.displacement_map_for_tests != nullptr)
        assign(*machine_.displacement_map_for_tests, schedule::displacement_map_for_tests);
    assign(machine_.normal_map, schedule::normal_map);
    assign(machine_.height_table, schedule::height_table);
    const schedule::Source& source = schedule_->source();
    machine_.triangle_queue.assign({source.highest(), source.history()});
    machine_.triangle_pass_or_tessellate->assign_most_ahead_of_parts(schedule_->most_ahead_of_parts());
    machine_.get_triangle.assign_parts_sent(schedule_->parts_sent());
    machine_.triangle_pass_or_tessellate->from_transform.assign_taken(schedule_->parts_sent());
    for (unsigned k = 0; k < machine_.tessellation_tests.size(); ++k) {
        machine_.triangle_pass_or_tessellate->from_tessellation_tests[k].assign_taken(schedule_->edges(k));
        machine_.tessellation_tests[k].view_test.from_transform->assign_taken(schedule_->corners(k));
    }
    machine_.off_chip_memory.activity().finish(cycles);
}

}  // namespace tessera
