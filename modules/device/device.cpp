#include "modules/device/device.h"

#include <algorithm>
#include <string>

#include "modules/datapath/table_shapes.h"
#include "modules/device/records.h"
#include "modules/timing/design_keys.h"

namespace tessera {

namespace {

/// Registers for the largest map, which determine the capacities of the table memories.
datapath::Registers for_largest_map(datapath::Registers registers, const LargestMap& largest) {
    registers.map.width = largest.width;
    registers.map.height = largest.height;
    registers.covered = {largest.width, largest.height};
    datapath::shape_tables(registers);
    return registers;
}

/// SC_ERROR that names a member of the design, its value and its rule.
void refuse(const char* instance, const char* member, std::uint64_t value, const std::string& rule) {
    SC_REPORT_ERROR(
        "tessera/device",
        (std::string(instance) + ": DeviceDesign::" + member + " = " + std::to_string(value) + rule).c_str());
}

void require(const char* instance, const char* member, std::uint64_t value, std::uint64_t least, std::uint64_t most) {
    if (value < least || value > most)
        refuse(instance, member, value, ": must be " + std::to_string(least) + " to " + std::to_string(most));
}

constexpr unsigned most_register_cycles = 1 << 16;  // times the words of a burst: 32 bits

/// Checks the design before anything is built from it; Machine checks the machine's.
const DeviceDesign& checked(const DeviceDesign& design, const datapath::Registers& initial, const char* instance) {
    const int integer = initial.formats.texture.bits - 1 - initial.formats.texture.fraction;
    constexpr auto range = datapath::FormatLimits::texture_integer;
    if (integer >= range.least && integer <= range.most) {  // Machine refuses others
        require(instance, "largest_map.width", design.largest_map.width, 1, std::uint64_t{1} << integer);
        require(instance, "largest_map.height", design.largest_map.height, 1, std::uint64_t{1} << integer);
    }
    require(instance, "register_cycles", design.register_cycles, 1, most_register_cycles);
    require(instance, "burst_bytes", design.burst_bytes, 4, 4096);
    if ((design.burst_bytes & (design.burst_bytes - 1)) != 0)
        refuse(instance, "burst_bytes", design.burst_bytes, ": must be a power of two");
    require(instance, "triangles_ahead", design.triangles_ahead, 1, most_places);
    require(instance, "finished_triangles", design.finished_triangles, 1, most_places);
    if (design.machine.queue.capacity != 0 && design.machine.queue.overflow != QueueOverflow::spill)
        refuse(instance, "machine.queue.capacity", design.machine.queue.capacity,
               ": a bounded queue that does not spill could stop the machine permanently: must be with "
               "queue.overflow = QueueOverflow::spill");
    return design;
}

}  // namespace

Device::Device(const sc_core::sc_module_name& name, const datapath::Registers& initial, const DeviceDesign& design,
               UnitFactory* factory)
    : sc_module(name),
      design_(checked(design, initial, this->name())),
      live_(for_largest_map(initial, design.largest_map)),
      machine_("machine", live_, design.machine, factory),
      streams_("streams", machine_.clock, design.machine, design.triangles_ahead, design.finished_triangles),
      file_(initial, design.largest_map),
      reading_("reading", bus, design.burst_bytes, design.machine.transport == Transport::blocking,
               machine_.answer_limit()),
      writing_("writing", bus, design.burst_bytes, design.machine.transport == Transport::blocking,
               machine_.answer_limit()),
      burst_(design.burst_bytes),
      most_waiting_(std::max<std::uint64_t>(design.machine.queue.capacity, design.machine.queue.off_chip_triangles)) {
    registers.register_b_transport(this, &Device::b_transport);
    registers.register_transport_dbg(this, &Device::transport_dbg);
    streams_.to_get_triangle.bind(machine_.get_triangle.from_host);
    machine_.lighting.to_rasteriser.bind(streams_.from_lighting);
    machine_.pass_or_tessellate.decided.bind(*this);
    SC_HAS_PROCESS(Device);
    SC_THREAD(run_frames);
    SC_THREAD(write_records);
    SC_METHOD(reset_changed);
    SC_METHOD(drive_interrupt);
    sensitive << interrupt_changed_;
}

Device::~Device() = default;

void Device::start(const sc_core::sc_time& delay) {
    const datapath::Registers machine = file_.machine();
    status_ &= ~(status_done | status_error);
    failure_ = check(machine);
    if (failure_.error != DeviceError::none) {
        status_ |= status_error;
        raise(interrupt_error);
        return;
    }
    live_ = machine;
    machine_.clock.run_ahead(0);  // the bus depends on time
    machine_.tables_changed();
    machine_.begin_frame();
    finished_before_ = machine_.pass_or_tessellate.counts().finished;
    triangles_sent_ = write_index_ = read_index_ = 0;
    ring_place_ = 0;
    stopped_ = false;
    streams_.discard(false);
    status_ |= status_busy;
    started_.notify(delay);
}

void Device::run_frames() {
    for (;;) {
        wait(started_);
        reading_.synchronise();
        if (fetch_tables())
            send_triangles();
        reading_.synchronise();
        machine_.end_frame();
        wait_until_empty();
        check_tables();
        end_frame();
    }
}

/// Returns false if the frame must stop.
bool Device::fetch_tables() {
    const datapath::Formats& f = live_.formats;
    return fetch(0, machine_.displacement_map, offset::displacement_map_address, live_.displacement_map,
                 f.displacement.bits) &&
           fetch(1, machine_.normal_map, offset::normal_map_address, live_.normal_map, 3 * f.normal.bits) &&
           fetch(2, machine_.height_table, offset::summed_height_table_address, live_.height_table,
                 datapath::height_entry_bits(f));
}

/// Copies burst by burst into the table memory by debug transport, only `bits` bits of an entry.
bool Device::fetch(unsigned number, const TableMemory& table, std::uint32_t source, const datapath::TableLayout& layout,
                   int bits) {
    if ((file_.value(offset::fetch) >> number & 1) == 0)
        return !stopped_;
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    Fetched& fetched = fetched_[number];
    fetched = {&table, layout.base, {}};
    filled_[number] = {};
    std::uint64_t length = 0;
    for (std::uint64_t done = 0; done < layout.bytes() && !stopped_; done += length) {
        const std::uint64_t address = file_.value(source) + done;
        length = std::min<std::uint64_t>(layout.bytes() - done, design_.burst_bytes - address % design_.burst_bytes);
        if (!reading_.read(address, burst_.data(), length)) {
            stop(DeviceError::table_read, reading_.failed_at());
            return false;
        }
        for (std::uint64_t k = 0; k < length; ++k)
            burst_[k] &= static_cast<unsigned char>(mask >> 8 * ((done + k) % layout.entry_bytes));
        if (!machine_.write_table(table, layout.base + done, burst_.data(), length)) {
            stop(DeviceError::table_memory, address);
            return false;
        }
        if (machine_.reads_tables_elsewhere())
            fetched.bytes.insert(fetched.bytes.end(), burst_.begin(),
                                 burst_.begin() + static_cast<std::ptrdiff_t>(length));
    }
    if (!stopped_)
        filled_[number] = layout;
    return !stopped_;
}

/// A memory that is not the machine's may have been written by another device during the frame, or since the fetch.
void Device::check_tables() {
    for (const Fetched& fetched : fetched_)
        if (!fetched.bytes.empty() &&
            !machine_.holds_table(*fetched.table, fetched.base, fetched.bytes.data(), fetched.bytes.size()))
            stop(DeviceError::table_memory, 0);
}

void Device::send_triangles() {
    const std::uint64_t count = file_.value(offset::triangles_count), first = file_.value(offset::triangles_address);
    std::array<unsigned char, base_triangle_bytes> record{};
    for (std::uint64_t k = 0; k < count && !stopped_; ++k) {
        const std::uint64_t address = first + k * base_triangle_bytes;
        datapath::Triangle triangle;
        if (!reading_.read(address, record.data(), record.size())) {
            stop(DeviceError::triangle_read, reading_.failed_at());
        } else if (!read_base_triangle(record.data(), live_.formats, triangle)) {
            stop(DeviceError::bad_triangle, address);
        } else if (!stopped_) {
            triangle.base = static_cast<std::uint32_t>(k);
            ++triangles_sent_;
            sc_core::sc_time delay = reading_.local_time();
            streams_.send(triangle, delay);
            reading_.set_local_time(delay);
        }
    }
}

void Device::wait_until_empty() {
    while (!(machine_.idle() && streams_.idle() && !record_under_way_)) {
        if (machine_.clock.halted()) {
            stop(DeviceError::machine_stopped, 0);
            return;
        }
        wait(machine_.drained() | machine_.clock.quiet() | written_);
    }
}

void Device::end_frame() {
    reading_.rest();
    writing_.rest();
    if ((status_ & status_resetting) != 0) {
        reset_registers();
        return;
    }
    const bool done = failure_.error == DeviceError::none;
    status_ = done ? status_done : status_error;
    raise(done ? interrupt_done : interrupt_error);
}

/// The first error is kept. No edge is split from now on, so that the machine empties soon: the software's settings
/// might otherwise split without end.
void Device::stop(DeviceError error, std::uint64_t address) {
    if (!stopped_)
        failure_ = {error, address};
    stopped_ = true;
    live_.tests.generation_test = true;
    live_.tests.generation_limit = 0;
    streams_.discard(true);
    stop_.notify(sc_core::SC_ZERO_TIME);
}

/// The machine has decided a triangle. Waiting triangles are counted together with the children of all triangles under
/// way, which can still be added when splitting ends: the queue would halt the machine for good if its memory were
/// full.
void Device::write(const datapath::TrianglePass&) {
    if (stopped_)
        return;
    const Machine& p = machine_;
    std::uint64_t waiting = p.triangle_queue.waiting();
    if (design_.machine.transport == Transport::non_blocking)
        waiting +=
            p.triangle_queue.from_tessellation.size() + 1 +
            4 * (p.passes_under_way() + p.tessellation.activity().level() + p.pass_or_tessellate.activity().level());
    if (waiting > most_waiting_)
        stop(DeviceError::queue_full, 0);
}

bool Device::ring_full() const {
    return write_index_ - read_index_ >= file_.value(offset::ring_size);
}

void Device::write_records() {
    for (;;) {
        while (!streams_.has_finished() || ring_full()) {
            writing_.synchronise();
            if (streams_.has_finished() && !ring_full())
                break;
            record_under_way_ = false;
            written_.notify(sc_core::SC_ZERO_TIME);
            wait(streams_.come() | ring_read_ | stop_);
        }
        record_under_way_ = true;
        write_record(streams_.take());
    }
}

void Device::write_record(const FrameStreams::Finished& finished) {
    const sc_core::sc_time now = sc_core::sc_time_stamp() + writing_.local_time();
    if (finished.time > now)
        writing_.set_local_time(finished.time - sc_core::sc_time_stamp());
    if (stopped_)
        return;
    std::array<unsigned char, finished_triangle_bytes> record{};
    write_finished_triangle(finished.triangle, record.data());
    const std::uint64_t address = file_.value(offset::ring_address) + ring_place_ * finished_triangle_bytes;
    if (!writing_.write(address, record.data(), record.size())) {
        stop(DeviceError::ring_write, writing_.failed_at());
        return;
    }
    ++write_index_;
    ring_place_ = ring_place_ + 1 == file_.value(offset::ring_size) ? 0 : ring_place_ + 1;
}

void Device::begin_reset() {
    if (!busy()) {
        reset_registers();
        return;
    }
    status_ |= status_resetting;
    pending_interrupts_ = 0;
    interrupt_changed_.notify(sc_core::SC_ZERO_TIME);
    stop(DeviceError::none, 0);
}

void Device::reset_registers() {
    file_.reset();
    failure_ = {};
    status_ = 0;
    pending_interrupts_ = 0;
    triangles_sent_ = write_index_ = read_index_ = 0;
    finished_before_ = machine_.pass_or_tessellate.counts().finished;
    interrupt_changed_.notify(sc_core::SC_ZERO_TIME);
}

void Device::reset_changed() {
    if (reset.size() == 0)
        return;  // no static sensitivity: never called again
    next_trigger(reset->value_changed_event());
    if (reset_held())
        begin_reset();
}

void Device::raise(std::uint32_t interrupt_bits) {
    pending_interrupts_ |= interrupt_bits;
    interrupt_changed_.notify(sc_core::SC_ZERO_TIME);
}

/// A single process drives the signal for all changes of the registers.
void Device::drive_interrupt() {
    if (interrupt.size() > 0)
        interrupt->write((pending_interrupts_ & file_.value(offset::interrupt_enable)) != 0);
}

}  // namespace tessera
