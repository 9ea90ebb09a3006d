#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>
#include <array>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/device/dma_channel.h"
#include "modules/device/frame_streams.h"
#include "modules/device/register_file.h"
#include "modules/machine.h"

namespace tessera {

/// The parameters of a device: the machine, and what is built around it.
struct DeviceDesign {
    Design machine;                   ///< its queue must spill, or be unbounded
    LargestMap largest_map;           ///< sizes the table memories; also limits a Rank Table's columns and rows
    unsigned register_cycles = 1;     ///< cycles of the machine's clock for each word of a register access
    unsigned burst_bytes = 64;        ///< of a DMA transfer: a power of two, 4 to 4096
    unsigned triangles_ahead = 4;     ///< base triangles fetched before Get Triangle accepts them (timed mode)
    unsigned finished_triangles = 8;  ///< finished triangles that wait to be written
};

/// The machine (machine.h) as a device on a bus: registers, DMA, interrupt.
///
/// In:        `registers`: TLM-2.0 base protocol, loosely timed (b_transport) and approximately timed (nb_transport).
///            Words of 32 bits, little endian, at the offsets of REGISTERS.md. An access is of one or more whole words,
///            aligned. It takes effect as a whole, in ascending order, or not at all:
///            TLM_BURST_ERROR: not whole aligned words, or a streaming width, other than 0, below the length.
///            TLM_BYTE_ENABLE_ERROR: a byte is not enabled. TLM_ADDRESS_ERROR: no register there. TLM_COMMAND_ERROR: a
///            write to a read-only register, or no command of TLM-2.0. TLM_GENERIC_ERROR: no data pointer, or a write
///            refused at present (a frame is under way, reset is held, or the read index would pass the write index).
///            TLM_IGNORE_COMMAND: does nothing, anywhere, and succeeds. transport_dbg: reads, and writes of plain
///            registers, without side effects. DMI: refused. `reset`: optional; while high the device is in reset.
/// Out:       `bus`: base protocol, b_transport with annotated delay; two transfers may be under way at a time, one
///            reading and one writing. `interrupt`: optional; level.
/// Frame:     accesses change a copy of the machine's registers. start checks it as a whole and passes it on: the
///            machine never sees part of a change, nor values that its arithmetic excludes. Then the device copies the
///            tables selected by `fetch` to the memories that the units read (Machine::write_table; entry bits beyond
///            the format are dropped), sends the base triangles to the machine, and writes each finished triangle that
///            is not culled to the ring (records.h). done and interrupt follow when all are written. While the ring is
///            full (write index - read index = size) the machine is held back. Each frame resets indices and counters.
/// Errors:    software errors set `error` and interrupt. A refused frame changes nothing else. A stopped frame
///            continues until the machine is empty; its finished triangles are dropped, and no record is begun.
/// Reset:     stops a frame in the same way. The machine's units have no reset wires: the triangles in the machine go
///            through it, with a Generation Test that splits no further edge, so that even a recursion without end
///            ends. (Decision: emptying every ring, pipeline and memory queue would add a second behaviour to each.)
///            busy and resetting stay set until the machine is empty, and while `reset` is high; then all registers have
///            their reset values. The tables keep their contents; one that was being fetched must be fetched again.
/// Timing:    an access takes `register_cycles` for each word, a refused one for one word. While a frame is under way
///            an access first waits for the initiator's delay to pass. DMA: dma_channel.h. Functional mode obeys the
///            global quantum; timed mode waits for each burst's delay to pass. A bus, or a table memory of a
///            UnitFactory, that does not answer for Design::answer_cycles is an SC_ERROR.
/// Capacity:  `triangles_ahead` and `finished_triangles`. Triangles that wait, or can be added by those under way: as
///            many as the Triangle Queue or its off-chip memory holds, whichever holds more (unbounded queue: as many
///            as off-chip memory). Beyond that the frame is stopped, since a queue that overflows halts the clock for
///            good. All children that those under way may have are counted, so that it may stop somewhat early.
class Device : public sc_core::sc_module, private tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    tlm_utils::simple_target_socket<Device> registers{"registers"};
    tlm_utils::simple_initiator_socket<Device> bus{"bus"};
    sc_core::sc_port<sc_core::sc_signal_inout_if<bool>, 1, sc_core::SC_ZERO_OR_MORE_BOUND> interrupt{"interrupt"};
    sc_core::sc_port<sc_core::sc_signal_in_if<bool>, 1, sc_core::SC_ZERO_OR_MORE_BOUND> reset{"reset"};

    /// initial: the formats, and the reset values of the machine's registers. factory: see Machine.
    /// SC_ERROR if the design or the formats cannot work.
    Device(const sc_core::sc_module_name& name, const datapath::Registers& initial, const DeviceDesign& design,
           UnitFactory* factory = nullptr);
    ~Device() override;

    /// For statistics, and to observe the units. Its registers change at the start of a frame.
    Machine& machine() { return machine_; }
    bool busy() const { return (status_ & status_busy) != 0; }

  private:
    struct Failure {
        DeviceError error = DeviceError::none;
        std::uint64_t address = 0;
    };

    // register accesses
    void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
    unsigned transport_dbg(tlm::tlm_generic_payload& payload);
    tlm::tlm_response_status access(tlm::tlm_generic_payload& payload, const sc_core::sc_time& delay);
    tlm::tlm_response_status may_write(std::uint64_t offset, std::uint32_t word) const;
    std::uint32_t read(std::uint32_t offset) const;
    void write(std::uint32_t offset, std::uint32_t word, const sc_core::sc_time& delay);
    void start(const sc_core::sc_time& delay);
    Failure check(const datapath::Registers& machine) const;
    Failure check_tables_filled(const datapath::Registers& machine) const;
    Failure check_transfers(const datapath::Registers& machine) const;

    // the frame
    void run_frames();
    bool fetch_tables();
    bool fetch(unsigned number, const TableMemory& table, std::uint32_t source, const datapath::TableLayout& layout,
               int bits);
    void check_tables();
    void send_triangles();
    void write_records();
    void write_record(const FrameStreams::Finished& finished);
    void wait_until_empty();
    void end_frame();
    void stop(DeviceError error, std::uint64_t address);
    void write(const datapath::TrianglePass& decided) override;  // of the analysis port
    bool ring_full() const;

    void reset_changed();
    bool reset_held() const { return reset.size() > 0 && reset->read(); }
    void begin_reset();
    void reset_registers();
    void raise(std::uint32_t interrupt_bits);
    void drive_interrupt();

    DeviceDesign design_;
    datapath::Registers live_;  // the machine's registers: those of the frame under way
    Machine machine_;
    FrameStreams streams_;
    RegisterFile file_;
    DmaChannel reading_;
    DmaChannel writing_;
    std::vector<unsigned char> burst_;  // of a table, under way

    std::uint32_t status_ = 0;
    std::uint32_t pending_interrupts_ = 0;
    Failure failure_;
    bool stopped_ = false;           // the frame ends early
    bool record_under_way_ = false;  // or written ahead of simulated time
    std::uint32_t triangles_sent_ = 0;
    std::uint64_t finished_before_ = 0;  // by the machine, in earlier frames
    std::uint32_t write_index_ = 0;
    std::uint32_t read_index_ = 0;
    std::uint64_t ring_place_ = 0;  // of the next record
    std::uint64_t most_waiting_;    // triangles in the machine's queue
    struct Fetched {
        const TableMemory* table = nullptr;
        std::uint64_t base = 0;
        std::vector<unsigned char> bytes;
    };
    std::array<Fetched, 3> fetched_;  // the tables, if the machine reads any from a memory that is not its own
    std::array<datapath::TableLayout, 3> filled_;  // by the last complete fetch of each

    sc_core::sc_event started_{"started"};
    sc_core::sc_event ring_read_{"ring_read"};
    sc_core::sc_event stop_{"stop"};
    sc_core::sc_event written_{"written"};
    sc_core::sc_event interrupt_changed_{"interrupt_changed"};
};

}  // namespace tessera
