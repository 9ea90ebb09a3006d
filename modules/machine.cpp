#include "modules/machine.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/pack_triangle.h"
#include "modules/timing/all_units.h"
#include "modules/timing/design_check.h"

namespace tessera {

namespace {

UnitFactory& standard_units() {
    static UnitFactory factory;
    return factory;
}

/// Before anything is built from it: SC_ERROR if the design, or the formats, cannot work.
const Design& checked(const Design& design, const datapath::Registers& registers, const char* name) {
    std::string faults = design_faults(design, registers.formats);
    if (!faults.empty()) {
        faults.pop_back();
        SC_REPORT_ERROR("tessera/machine", (std::string(name) + ": " + faults).c_str());
    }
    return design;
}

}  // namespace

Machine::Machine(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Design& design,
                 UnitFactory* factory)
    : sc_module(name),
      clock("clock",
            checked(design, registers, this->name()).clock != nullptr
                ? design.clock->period()
                : clock_period(this->name(), design.timing.cycle_picoseconds),
            design.clock != nullptr ? first_rising_edge(*design.clock) : sc_core::SC_ZERO_TIME),
      netlist_((this->*(design.work == Work::triangle ? &Machine::triangle_design : &Machine::family_design))(
          {{clock, registers, design}, factory == nullptr ? standard_units() : *factory})),
      off_chip_memory("off_chip_memory", clock, design.timing.off_chip_memory, design.timing.stalls,
                      design.queue.off_chip_triangles *
                          (datapath::packed_triangle_bytes(registers.formats) + datapath::packed_triangle_tag_bytes),
                      datapath::packed_triangle_tag_bytes),
      displacement_map("displacement_map", clock, registers.displacement_map, design.timing.displacement_map,
                       design.timing.stalls, &off_chip_memory.channel()),
      displacement_map_for_tests(make_second_side(registers, design)),
      normal_map("normal_map", clock, registers.normal_map, design.timing.normal_map, design.timing.stalls,
                 &off_chip_memory.channel()),
      height_table(functions_of(registers.formats.height_test).table().c_str(), clock, registers.height_table,
                   height_table_timing(design.timing, registers.formats), design.timing.stalls,
                   &off_chip_memory.channel()),
      displacement_map_cache(make_cache("displacement_map_cache", registers.displacement_map,
                                        design.timing.displacement_map, design.timing.stalls)),
      normal_map_cache(
          make_cache("normal_map_cache", registers.normal_map, design.timing.normal_map, design.timing.stalls)),
      height_table_cache(make_cache((functions_of(registers.formats.height_test).table() + "_cache").c_str(),
                                    registers.height_table, height_table_timing(design.timing, registers.formats),
                                    design.timing.stalls)),
      registers_(registers),
      answer_limit_(clock.period() * design.answer_cycles),
      transport_(design.transport),
      random_stalls_(design.timing.stalls.per_mille > 0) {
    for (const std::type_index& replaced : netlist_.factory().unused())
        SC_REPORT_WARNING("tessera/machine",
                          (std::string(this->name()) + ": UnitFactory::replace() without effect: this " +
                           "design has no unit of the class " + replaced.name())
                              .c_str());
    list_units();
    attach();
    set_table_areas();
    wire();
    see_where_ports_lead();
    SC_HAS_PROCESS(Machine);
    SC_METHOD(see_whether_drained);
    dont_initialize();
    sensitive << clock.quiet() << triangle_queue.emptied() << frame_ended_;
}

/// A map's request reads one texel, or four with a bilinear filter; a rectangle's its corners: where it wraps on one axis
/// six, on both nine.
void Machine::set_table_areas() {
    const datapath::Registers& r = registers_;
    const datapath::Formats& f = r.formats;
    const datapath::HeightTestFunctions& height = functions_of(f.height_test);
    const unsigned texels = datapath::map_entry_count(f);
    const auto across = [](datapath::AddressMode mode) { return mode == datapath::AddressMode::repeat ? 3u : 2u; };
    const unsigned corners = across(r.map.address_u) * across(r.map.address_v);
    displacement_map.set_area(f.displacement.bits, texels);
    if (displacement_map_for_tests != nullptr)
        displacement_map_for_tests->set_area(f.displacement.bits, height.codes);
    normal_map.set_area(3 * f.normal.bits, texels);
    height_table.set_area(datapath::height_entry_bits(f), height.rectangles ? corners : 1);
}

std::unique_ptr<TableCache> Machine::make_cache(const char* name, const datapath::TableLayout& layout,
                                                const MemoryTiming& timing, const StallParameters& stalls) {
    return timing.cache.bytes == 0 ? nullptr : std::make_unique<TableCache>(name, clock, layout, timing, stalls);
}

std::unique_ptr<DisplacementMap> Machine::make_second_side(const datapath::Registers& registers, const Design& design) {
    if (!displacement_map_has_two_sides(design, registers.formats))
        return nullptr;
    return std::make_unique<DisplacementMap>("displacement_map_for_tests", clock, displacement_map,
                                             registers.displacement_map, design.timing.displacement_map,
                                             design.timing.stalls);
}

/// Joins a unit's port to the table, or to the cache in front of it.
void Machine::join(MemoryPort& port, TableMemory& memory) {
    const auto table =
        std::find_if(tables_.begin(), tables_.end(), [&](const Table& t) { return t.memory == &memory; });
    if (table->cache == nullptr)
        netlist_.factory().join(port, memory);
    else
        netlist_.factory().join(port, *table->cache);
    readers_.push_back({&port, &memory == displacement_map_for_tests.get() ? &displacement_map : &memory});
}

namespace {

/// Whether the port is joined to one of the machine's memories, possibly by way of something else.
bool leads_to(const std::vector<Unit*>& units, const MemoryPort& port) {
    return std::any_of(units.begin(), units.end(), [&](const Unit* unit) { return port.memory() == unit; });
}

}  // namespace

/// Looks for ports that a UnitFactory has joined elsewhere: their memories might not answer, and others may write to
/// them.
void Machine::see_where_ports_lead() {
    for (const Table& table : tables_)
        if (table.memory != displacement_map_for_tests.get() &&
            std::none_of(readers_.begin(), readers_.end(), [&](const TableReader& reader) {
                return reader.table == table.memory && leads_to(units_, *reader.port);
            }))
            table.memory->has_no_reader();
    std::vector<MemoryPort*> ports;
    for (const TableReader& reader : readers_)
        ports.push_back(reader.port);
    for (TableCache* cache : caches_)
        ports.push_back(&cache->table);
    for (MemoryPort* port : ports)
        tables_elsewhere_ = watch(*port) || tables_elsewhere_;
    if (watch(triangle_queue.off_chip_memory))
        triangle_queue.check_off_chip_memory();
}

/// Returns false if the port is joined to a memory of the machine, with nothing in between.
bool Machine::watch(MemoryPort& port) {
    if (!port.interposed() && leads_to(units_, port))
        return false;
    const auto state = [&port] {
        const auto* const memory = dynamic_cast<const Unit*>(port.memory());
        const std::string contents = memory == nullptr ? std::string{} : memory->describe_contents();
        const bool offered = port.on_offer() && port.requests_under_way() == 1;
        return std::string(offered ? ", not even END_REQ" : "") +
               (contents.empty() ? "" : " (" + std::string(memory->name()) + ": " + contents + ")");
    };
    const std::string name = "watch_" + std::to_string(watches_.size());
    watches_.push_back(std::make_unique<AnswerWatch>(name.c_str(), port.socket.name(), answer_limit_, state));
    port.watched_by(*watches_.back());
    if (!leads_to(units_, port))
        port.compare_contents();
    return true;
}

namespace {

bool report_table(const MemoryPort& port, std::uint64_t address, const char* what) {
    std::ostringstream message;
    message << port.socket.name() << ": " << what << " at address 0x" << std::hex << address;
    SC_REPORT_ERROR("tessera/machine", message.str().c_str());
    return false;
}

}  // namespace

bool Machine::write_table(const TableMemory& table, std::uint64_t address, const unsigned char* bytes,
                          std::size_t count) {
    for (const TableReader& reader : readers_)
        if (reader.table == &table && !reader.port->load(address, bytes, static_cast<unsigned>(count)))
            return report_table(
                *reader.port, address,
                leads_to(units_, *reader.port)
                    ? "the machine's own memory has room for the tables of the registers with which the machine was "
                      "built, at their addresses, and for no others; refused"
                    : "the memory that this port reads does not take the table's bytes by debug transport: give the "
                      "memory, and what is in front of it, transport_dbg for writes; refused");
    return true;
}

bool Machine::holds_table(const TableMemory& table, std::uint64_t address, const unsigned char* bytes,
                          std::size_t count) {
    for (const TableReader& reader : readers_)
        if (reader.table == &table && !reader.port->holds(address, bytes, static_cast<unsigned>(count)))
            return report_table(*reader.port, address,
                                "the memory that this port reads no longer holds the table that was written to it: "
                                "give each machine and table a memory, or addresses, of its own; changed");
    return true;
}

void Machine::begin_frame() {
    ++frames_begun_;
    frame_drained_ = false;
    get_triangle.begin_frame();
}

void Machine::end_frame() {
    --frames_begun_;
    frame_ended_.notify(sc_core::SC_ZERO_TIME);
}

void Machine::see_whether_drained() {
    const bool quiet = transport_ == Transport::blocking || clock.idle();
    if (!quiet || !idle())
        return;
    for (const auto& watch : watches_)
        watch->rest();
    if (frames_begun_ > 0 || std::exchange(frame_drained_, true))
        return;
    drained_.notify();
}

/// Lists units and memories for reports: units in the order of all_units, those of a Tessellation Tests unit together.
void Machine::list_units() {
    const auto place = [this](const Unit* unit) {
        return std::find_if(all_units.begin(), all_units.end(), [&](const UnitSpec& spec) {
            return unit->get_parent_object() != this ? spec.in_tests()
                                                     : unit->basename() == std::string_view(spec.name);
        });
    };
    units_ = netlist_.units();
    std::stable_sort(units_.begin(), units_.end(), [&](const Unit* a, const Unit* b) { return place(a) < place(b); });
    const datapath::Registers& r = registers_;
    tables_.push_back({&displacement_map, displacement_map_cache.get(), &r.displacement_map});
    if (displacement_map_for_tests != nullptr)
        tables_.push_back({displacement_map_for_tests.get(), nullptr, &r.displacement_map});
    tables_.push_back({&normal_map, normal_map_cache.get(), &r.normal_map});
    tables_.push_back({&height_table, height_table_cache.get(), &r.height_table});
    for (const Table& table : tables_) {
        units_.push_back(table.memory);
        if (table.cache != nullptr)
            caches_.push_back(table.cache);
    }
    units_.push_back(&off_chip_memory);
    units_.insert(units_.end(), caches_.begin(), caches_.end());
}

/// Downstream first (cycle_scheduler.h); a memory is downstream of what reads it.
void Machine::attach() {
    clock.attach(off_chip_memory);
    for (const Table& table : tables_)
        clock.attach(*table.memory);
    for (TableCache* cache : caches_)
        clock.attach(*cache);
    for (Unit* unit : netlist_.downstream_first())
        clock.attach(*unit);
}

void Machine::wire() {
    for (Unit* unit : units_)
        netlist_.factory().made(*unit);
    netlist_.bind();
    for (const Table& table : tables_)
        if (table.cache != nullptr)
            netlist_.factory().join(table.cache->table, *table.memory);
}

bool Machine::idle() const {
    if (transport_ == Transport::blocking)
        return triangle_queue.drained() && pass_or_tessellate.joined();
    return std::all_of(units_.begin(), units_.end(),
                       [](const Unit* unit) { return unit->idle() && unit->describe_contents().empty(); });
}

void Machine::tables_changed() {
    for (const Table& table : tables_) {
        table.memory->lay_out(table.layout->columns);
        if (table.cache != nullptr)
            table.cache->lay_out(table.layout->columns);
    }
}

std::uint64_t Machine::passes_under_way() const {
    return get_triangle.activity().items_in() + tessellation.waiting() - pass_or_tessellate.activity().items_out();
}

std::uint64_t Machine::reads(const TableMemory& table) const {
    std::uint64_t sum = 0;
    for (const TableReader& reader : readers_)
        if (reader.table == &table)
            sum += reader.port->reads();
    return sum;
}

datapath::Saturations Machine::saturations() const {
    datapath::Saturations all;
    for (const Unit* unit : units_)
        all += unit->saturations();
    return all;
}

}  // namespace tessera
