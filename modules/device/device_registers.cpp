// The register side of Device: accesses, and the checks at start.
#include "modules/datapath/preconditions.h"
#include "modules/device/device.h"
#include "modules/device/records.h"
#include "modules/sockets/generic_payload.h"

namespace tessera {

namespace {

/// Whether a transfer begins and ends at multiples of 4, and ends at 2^64 at the latest.
bool is_transfer(std::uint64_t address, std::uint64_t bytes) {
    return bytes == 0 || (address % 4 == 0 && address + (bytes - 1) >= address);
}

}  // namespace

void Device::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    if (busy()) {
        wait(delay);
        delay = sc_core::SC_ZERO_TIME;
    }
    payload.set_dmi_allowed(false);
    payload.set_response_status(access(payload, delay));
    const bool moved = payload.is_response_ok() && payload.get_command() != tlm::TLM_IGNORE_COMMAND;
    const unsigned words = moved ? payload.get_data_length() / 4 : 1;
    delay += machine_.clock.period() * (words * design_.register_cycles);
}

tlm::tlm_response_status Device::access(tlm::tlm_generic_payload& payload, const sc_core::sc_time& delay) {
    const std::uint64_t first = payload.get_address();
    const unsigned length = payload.get_data_length();
    if (payload.get_command() == tlm::TLM_IGNORE_COMMAND)
        return tlm::TLM_OK_RESPONSE;
    if (!payload.is_read() && !payload.is_write())
        return tlm::TLM_COMMAND_ERROR_RESPONSE;
    if (!all_bytes_enabled(payload))
        return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
    if (length == 0 || length % 4 != 0 || first % 4 != 0 || is_stream(payload))
        return tlm::TLM_BURST_ERROR_RESPONSE;
    if (payload.get_data_ptr() == nullptr)
        return tlm::TLM_GENERIC_ERROR_RESPONSE;
    if (first >= register_bytes || length > register_bytes - first)
        return tlm::TLM_ADDRESS_ERROR_RESPONSE;
    unsigned char* const data = payload.get_data_ptr();
    for (unsigned k = 0; k < length; k += 4)
        if (file_.find(first + k) == nullptr)
            return tlm::TLM_ADDRESS_ERROR_RESPONSE;
    if (payload.is_write()) {
        for (unsigned k = 0; k < length; k += 4) {
            const tlm::tlm_response_status refused = may_write(first + k, datapath::load_word(data + k));
            if (refused != tlm::TLM_OK_RESPONSE)
                return refused;
        }
    }
    for (unsigned k = 0; k < length; k += 4) {
        const auto offset = static_cast<std::uint32_t>(first + k);
        if (payload.is_read())
            datapath::store_word(read(offset), data + k);
        else
            write(offset, datapath::load_word(data + k), delay);
    }
    return tlm::TLM_OK_RESPONSE;
}

/// TLM_OK_RESPONSE, or the reason for refusing the write.
tlm::tlm_response_status Device::may_write(std::uint64_t offset, std::uint32_t word) const {
    const DeviceRegister& field = *file_.find(offset);
    if (field.access == RegisterAccess::read_only)
        return tlm::TLM_COMMAND_ERROR_RESPONSE;
    const bool starts = offset == offset::control && (word & control_start) != 0 && (word & control_reset) == 0;
    if (((!field.while_busy || starts) && busy()) || reset_held())
        return tlm::TLM_GENERIC_ERROR_RESPONSE;
    if (offset == offset::ring_read_index && word - read_index_ > write_index_ - read_index_)
        return tlm::TLM_GENERIC_ERROR_RESPONSE;
    return tlm::TLM_OK_RESPONSE;
}

std::uint32_t Device::read(std::uint32_t offset) const {
    switch (offset) {
        case offset::control: return 0;
        case offset::status: return status_ | (reset_held() ? status_busy | status_resetting : 0);
        case offset::interrupt: return pending_interrupts_;
        case offset::error: return static_cast<std::uint32_t>(failure_.error);
        case offset::error_address: return static_cast<std::uint32_t>(failure_.address);
        case offset::error_address + 4: return static_cast<std::uint32_t>(failure_.address >> 32);
        case offset::triangles_sent: return triangles_sent_;
        case offset::triangles_finished:
            return static_cast<std::uint32_t>(machine_.pass_or_tessellate.counts().finished - finished_before_);
        case offset::ring_write_index: return write_index_;
        case offset::ring_read_index: return read_index_;
        default: return file_.word(offset);
    }
}

void Device::write(std::uint32_t offset, std::uint32_t word, const sc_core::sc_time& delay) {
    switch (offset) {
        case offset::control:
            if ((word & control_reset) != 0)
                begin_reset();
            else if ((word & control_start) != 0)
                start(delay);
            break;
        case offset::interrupt:
            pending_interrupts_ &= ~word;
            interrupt_changed_.notify(sc_core::SC_ZERO_TIME);
            break;
        case offset::interrupt_enable:
            file_.set_word(offset, word);
            interrupt_changed_.notify(sc_core::SC_ZERO_TIME);
            break;
        case offset::ring_read_index:
            read_index_ = word;
            ring_read_.notify(sc_core::SC_ZERO_TIME);
            break;
        default: file_.set_word(offset, word);
    }
}

unsigned Device::transport_dbg(tlm::tlm_generic_payload& payload) {
    const std::uint64_t first = payload.get_address();
    unsigned moved = 0;
    if (first % 4 != 0 || payload.get_data_ptr() == nullptr)
        return 0;
    for (; payload.get_data_length() - moved >= 4; moved += 4) {
        const DeviceRegister* const field = file_.find(first + moved);
        unsigned char* const data = payload.get_data_ptr() + moved;
        if (field == nullptr)
            break;
        const auto offset = static_cast<std::uint32_t>(first + moved);
        if (payload.is_read())
            datapath::store_word(read(offset), data);
        else if (payload.is_write() && field->access == RegisterAccess::read_write && !field->while_busy && !busy() &&
                 !reset_held())
            file_.set_word(offset, datapath::load_word(data));
        else
            break;
    }
    return moved;
}

Device::Failure Device::check(const datapath::Registers& machine) const {
    const auto at = [&](DeviceError error, const char* name) { return Failure{error, file_.offset_of(name)}; };
    if (machine_.clock.halted())
        return {DeviceError::machine_stopped, 0};
    if (machine.map.width == 0 || machine.map.width > design_.largest_map.width)
        return at(DeviceError::bad_map_size, "map.width");
    if (machine.map.height == 0 || machine.map.height > design_.largest_map.height)
        return at(DeviceError::bad_map_size, "map.height");
    if (functions_of(machine.formats.height_test).covers_more) {
        const std::string table = functions_of(machine.formats.height_test).table();
        if (machine.covered.columns == 0 || machine.covered.columns > design_.largest_map.width)
            return at(DeviceError::bad_map_size, (table + ".columns").c_str());
        if (machine.covered.rows == 0 || machine.covered.rows > design_.largest_map.height)
            return at(DeviceError::bad_map_size, (table + ".rows").c_str());
    }
    if (const std::string excluded = datapath::excluded_register(machine); !excluded.empty())
        return at(DeviceError::bad_value, excluded.c_str());
    const Failure unfilled = check_tables_filled(machine);
    return unfilled.error != DeviceError::none ? unfilled : check_transfers(machine);
}

/// Of a memory that is not the machine's, the device cannot know who fills it.
Device::Failure Device::check_tables_filled(const datapath::Registers& machine) const {
    const std::array layouts{machine.displacement_map, machine.normal_map, machine.height_table};
    if (machine_.reads_tables_elsewhere())
        return {};
    for (std::size_t k = 0; k < layouts.size(); ++k) {
        const bool read = k != 2 || machine.tests.summed_height_test;
        if (read && (file_.value(offset::fetch) >> k & 1) == 0 && !(filled_[k] == layouts[k]))
            return {DeviceError::no_table, offset::fetch};
    }
    return {};
}

Device::Failure Device::check_transfers(const datapath::Registers& machine) const {
    struct Transfer {
        std::uint32_t address;  // offset of its register
        std::uint64_t bytes;
    };
    const std::uint64_t tables = file_.value(offset::fetch), size = file_.value(offset::ring_size);
    if (size == 0)
        return {DeviceError::bad_ring_size, offset::ring_size};
    for (const Transfer& transfer : {
             Transfer{offset::displacement_map_address, (tables & 1) != 0 ? machine.displacement_map.bytes() : 0},
             Transfer{offset::normal_map_address, (tables & 2) != 0 ? machine.normal_map.bytes() : 0},
             Transfer{offset::summed_height_table_address, (tables & 4) != 0 ? machine.height_table.bytes() : 0},
             Transfer{offset::triangles_address, file_.value(offset::triangles_count) * base_triangle_bytes},
             Transfer{offset::ring_address, size * finished_triangle_bytes},
         })
        if (!is_transfer(file_.value(transfer.address), transfer.bytes))
            return {DeviceError::bad_address, transfer.address};
    return {};
}

}  // namespace tessera
