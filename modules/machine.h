#pragma once
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "modules/memories/off_chip_memory.h"
#include "modules/memories/table_cache.h"
#include "modules/memories/table_memory.h"
#include "modules/netlist.h"
#include "modules/tessellation_tests.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/design.h"
#include "modules/units/calculate_new_p.h"
#include "modules/units/deciding_unit.h"
#include "modules/units/displace_vertex.h"
#include "modules/units/get_triangle.h"
#include "modules/units/joining_unit.h"
#include "modules/units/lighting.h"
#include "modules/units/tessellation.h"
#include "modules/units/transform.h"
#include "modules/units/triangle_queue.h"

namespace tessera {

/// The machine of the paper's figure 7: every unit, every memory, and the wires between them (netlists.cpp). In the
/// family design (Design::work) the queue holds triangles that are known to split, and their children are tested before
/// they enter the queue. Block diagrams: modules/README.md.
///
/// External: get_triangle.from_host, lighting.to_rasteriser; and write_table(), for the host.
class Machine : public sc_core::sc_module {
  public:
    CycleScheduler clock;

    sc_core::sc_vector<TessellationTests> tessellation_tests{"tessellation_tests"};

  private:
    Netlist netlist_;
    const JoiningUnit& join_ = netlist_.the<JoiningUnit>();

  public:
    // What each design has one of.
    GetTriangle& get_triangle = netlist_.the<GetTriangle>();
    CalculateNewP& calculate_new_p = netlist_.the<CalculateNewP>();
    DisplaceVertex& displace_vertex = netlist_.the<DisplaceVertex>();
    Transform& transform = netlist_.the<Transform>();
    DecidingUnit& pass_or_tessellate = netlist_.the<DecidingUnit>();
    TessellatingUnit& tessellation = netlist_.the<TessellatingUnit>();
    TriangleQueue& triangle_queue = netlist_.the<TriangleQueue>();
    Lighting& lighting = netlist_.the<Lighting>();
    OffChipMemory off_chip_memory;
    DisplacementMap displacement_map;
    std::unique_ptr<DisplacementMap> displacement_map_for_tests;  ///< its second side; null: none
    NormalMap normal_map;
    HeightTable height_table;
    std::unique_ptr<TableCache> displacement_map_cache;  ///< null: the table is on chip
    std::unique_ptr<TableCache> normal_map_cache;
    std::unique_ptr<TableCache> height_table_cache;

    /// `registers` must outlive the pipeline. factory: null for the units of this folder. From now on these are fixed:
    /// the formats, except the view distance's fraction; the tables' bases and entry sizes; the memories' capacities,
    /// which are those of the tables that `registers` describe.
    Machine(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Design& design,
            UnitFactory* factory = nullptr);

    /// True if nothing is in flight.
    bool idle() const;

    /// Writes bytes of a table at an address of its layout, by debug transport through every port that reads the table:
    /// to wherever a UnitFactory has joined it. table: one of this machine's. SC_ERROR that names the port, and false,
    /// if a memory does not take the bytes, or then reads as others.
    bool write_table(const TableMemory& table, std::uint64_t address, const unsigned char* bytes, std::size_t count);
    /// False, after an SC_ERROR that names the port, if one now reads other bytes of the table.
    bool holds_table(const TableMemory& table, std::uint64_t address, const unsigned char* bytes, std::size_t count);
    /// True if a port reads a table from a memory that is not this machine's, which others may write.
    bool reads_tables_elsewhere() const { return tables_elsewhere_; }
    /// Call while idle when a table's content or columns have changed.
    void tables_changed();

    /// A source of triangles calls these before the first and after the last of a frame: a triangle before any frame is an
    /// SC_ERROR. Several may, also at the same time.
    void begin_frame();
    void end_frame();
    /// Notified once a frame, in both modes: no source has triangles left, and nothing is in flight.
    const sc_core::sc_event& drained() const { return drained_; }

    /// Every unit and memory, units in the order of all_units.h.
    const std::vector<Unit*>& units() const { return units_; }
    /// The units in the order of the data's flow, of any class: netlist().the<PassOrTessellate>().
    const Netlist& netlist() const { return netlist_; }
    /// The caches of the tables that have one.
    const std::vector<TableCache*>& caches() const { return caches_; }

    /// Design::answer_cycles in simulated time.
    const sc_core::sc_time& answer_limit() const { return answer_limit_; }

    Transport transport() const { return transport_; }
    const datapath::Registers& registers() const { return registers_; }

    /// True if items are held back at random.
    bool random_stalls() const { return random_stalls_; }

    /// Triangles between Get Triangle and the end of their pass, in Tessellation or on the way to Lighting.
    std::uint64_t passes_under_way() const;
    /// Most triangles that waited for their first part at the unit that joins the parts.
    std::size_t most_ahead_of_parts() const { return join_.most_ahead_of_parts(); }
    std::uint64_t edges_tested() const { return pass_or_tessellate.counts().edges_tested; }
    std::uint64_t displacement_map_reads() const { return reads(displacement_map); }
    std::uint64_t normal_map_reads() const { return reads(normal_map); }
    std::uint64_t height_table_reads() const { return reads(height_table); }
    datapath::Saturations saturations() const;

  private:
    struct TableReader {
        MemoryPort* port;
        const TableMemory* table;
    };

    /// A table's memory, or the second side of a dual-port one.
    struct Table {
        TableMemory* memory;
        TableCache* cache;  ///< null: none
        const datapath::TableLayout* layout;
    };

    // The list of each design (netlists.cpp), and what they share.
    Netlist triangle_design(Netlist net);
    Netlist family_design(Netlist net);
    void add_geometry(Netlist& net);
    template <class AnyUnit>
    static AnyUnit& add_join(Netlist& net, const char* name);
    void add_tests(Netlist& net);
    void add_ends(Netlist& net, StreamOutput<datapath::Triangle>& to_triangle_queue, DecidingUnit& deciding);
    void list_units();
    void wire();
    std::unique_ptr<TableCache> make_cache(const char* name, const datapath::TableLayout& layout,
                                           const MemoryTiming& timing, const StallParameters& stalls);
    std::unique_ptr<DisplacementMap> make_second_side(const datapath::Registers& registers, const Design& design);
    void set_table_areas();
    void join(MemoryPort& port, TableMemory& memory);
    std::uint64_t reads(const TableMemory& table) const;
    void see_where_ports_lead();
    bool watch(MemoryPort& port);
    void attach();
    void see_whether_drained();

    sc_core::sc_event drained_{"drained"};
    sc_core::sc_event frame_ended_{"frame_ended"};
    unsigned frames_begun_ = 0;  // and not ended, by the sources
    bool frame_drained_ = true;  // before the first, too
    std::vector<Unit*> units_;
    std::vector<TableReader> readers_;
    bool tables_elsewhere_ = false;
    std::vector<std::unique_ptr<AnswerWatch>> watches_;
    const datapath::Registers& registers_;
    const sc_core::sc_time answer_limit_;
    Transport transport_;
    bool random_stalls_;
    std::vector<Table> tables_;
    std::vector<TableCache*> caches_;
};

}  // namespace tessera
