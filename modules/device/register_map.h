#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"

namespace tessera {

enum class RegisterAccess : std::uint8_t {
    read_only,           ///< a write is refused
    read_write,          ///< refused while a frame is under way, unless `while_busy`
    command,             ///< a 1 acts and clears itself: reads 0
    write_one_to_clear,  ///< a 1 clears the bit
};

/// A register as software sees it. Bits beyond `bits` read as 0 (in a signed register as its sign) and are dropped when
/// written.
struct DeviceRegister {
    std::string name;
    std::uint32_t offset;  ///< in bytes, a multiple of 4
    int bits;              ///< up to 64; more than 32 may take a second word, which follows the lower one
    int words;             ///< 1 or 2
    bool is_signed;
    std::uint64_t reset;
    RegisterAccess access;
    bool while_busy;        ///< may be written while a frame is under way
    std::string only_with;  ///< the register exists only in designs with this test; empty: in all designs
    std::string meaning;
};

/// One bit of a control register.
struct RegisterBit {
    const char* register_name;
    std::string name;
    int bit;
    std::string meaning;
};

/// The offsets of the control registers that the device itself uses.
namespace offset {
inline constexpr std::uint32_t id = 0x000, version = 0x004, control = 0x008, status = 0x00c, interrupt = 0x010,
                               interrupt_enable = 0x014, error = 0x018, error_address = 0x020, fetch = 0x028,
                               displacement_map_address = 0x030, normal_map_address = 0x038,
                               summed_height_table_address = 0x040, triangles_address = 0x048, triangles_count = 0x050,
                               triangles_sent = 0x054, triangles_finished = 0x058, ring_address = 0x060,
                               ring_size = 0x068, ring_write_index = 0x06c, ring_read_index = 0x070;
inline constexpr std::uint32_t machine = 0x100;  ///< the first register of the machine
}  // namespace offset

inline constexpr std::uint32_t register_bytes = 0x400;  ///< the device's part of the bus's address space

inline constexpr std::uint32_t control_start = 1, control_reset = 2;
inline constexpr std::uint32_t status_busy = 1, status_done = 2, status_error = 4, status_resetting = 8;
inline constexpr std::uint32_t interrupt_done = 1, interrupt_error = 2;

/// Besides those of the height tests in `features`.
inline const std::array<RegisterBit, 17> control_bits{{
    {"control", "start", 0, "starts a frame"},
    {"control", "reset", 1, "stops a frame and sets all registers to their reset values"},
    {"status", "busy", 0, "a frame is being processed, or a reset is waiting for the machine to drain"},
    {"status", "done", 1, "the last frame is complete: all its triangles are in memory"},
    {"status", "error", 2, "the last frame was refused or stopped: see error"},
    {"status", "resetting", 3, "a reset is in progress"},
    {"interrupt", "done", 0, "a frame was completed"},
    {"interrupt", "error", 1, "a frame was refused or stopped"},
    {"fetch", "displacement_map", 0, "the next frame fetches this table"},
    {"fetch", "normal_map", 1, "the next frame fetches this table"},
    {"fetch", "summed_height_table", 2, "the next frame fetches this table"},
    {"features", "highlight", 0, "a Highlight Test"},
    {"features", "final_edges", 1, "queue entries mark final edges"},
    {"features", "codes", 2, "vertices carry displacement codes"},
    {"features", "families", 3, "the family design"},
    {"features", "bilinear", 4, "bilinear filter for the maps"},
    {"features", "distances", 7, "a view-dependent Rank Test"},
}};

/// All, those of a register in their order.
std::vector<RegisterBit> register_bits();

/// The reason for refusing or stopping a frame: register `error`. The meaning states what `error_address` then holds.
enum class DeviceError : std::uint8_t {
    none,
    bad_value,
    bad_map_size,
    bad_address,
    bad_ring_size,
    table_read,
    triangle_read,
    bad_triangle,
    ring_write,
    queue_full,
    machine_stopped,
    table_memory,
    no_table,
};

struct ErrorMeaning {
    DeviceError error;
    const char* name;
    const char* meaning;
};
inline constexpr std::array<ErrorMeaning, 13> error_meanings{{
    {DeviceError::none, "none", "no error"},
    {DeviceError::bad_value, "bad_value", "refused: an invalid register value; the register's offset"},
    {DeviceError::bad_map_size, "bad_map_size",
     "refused: an empty map, or one larger than the device supports; the register's offset"},
    {DeviceError::bad_address, "bad_address",
     "refused: an address that is not a multiple of 4, or data that extend beyond 2^64; the register's offset"},
    {DeviceError::bad_ring_size, "bad_ring_size", "refused: a ring of size 0; the register's offset"},
    {DeviceError::table_read, "table_read", "stopped: bus error on a read of a table; the address"},
    {DeviceError::triangle_read, "triangle_read", "stopped: bus error on a read of a base triangle; the address"},
    {DeviceError::bad_triangle, "bad_triangle",
     "stopped: a value of a base triangle does not fit its format; the record's address"},
    {DeviceError::ring_write, "ring_write", "stopped: bus error on a write to the ring; the address"},
    {DeviceError::queue_full, "queue_full",
     "stopped: the waiting triangles would not fit the Triangle Queue's memory; 0"},
    {DeviceError::machine_stopped, "machine_stopped",
     "refused or stopped: the machine's clock has halted, and a reset has no effect; 0"},
    {DeviceError::table_memory, "table_memory",
     "stopped: a memory outside the machine refused a table, or was changed by another; the bus address of the refused "
     "data, or 0"},
    {DeviceError::no_table, "no_table",
     "refused: a table that is not to be fetched and never was, whole and in this size; the register's offset"},
}};

/// Columns and rows of the largest map that the table memories hold.
struct LargestMap {
    std::uint32_t width = 1024;
    std::uint32_t height = 1024;
};

/// The table of all registers, in order of their offsets: control registers, below 0x100, then those of the machine
/// (datapath::describe_registers), each choice in a word of its own, so that software sets one without reading its
/// neighbours. `reset`: the formats, and the machine's reset values. The offsets are the same in every design, so that
/// one C header serves all; widths follow from the formats.
std::vector<DeviceRegister> register_map(const datapath::Registers& reset, const LargestMap& largest);

}  // namespace tessera
