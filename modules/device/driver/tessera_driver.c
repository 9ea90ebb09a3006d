#include "modules/device/driver/tessera_driver.h"

struct register_info {
    const char* name;
    uint32_t offset;
    int bits, words, is_signed, writable;
};

#define REGISTER_INFO(name, offset, bits, words, is_signed, writable) {#name, offset, bits, words, is_signed, writable},
static const struct register_info register_infos[] = {TESSERA_REGISTER_LIST(REGISTER_INFO)};
#undef REGISTER_INFO

static int read_register(struct tessera_driver* driver, uint32_t offset, uint32_t* value) {
    return driver->platform.read32(driver->platform.context, offset, value) == 0 ? TESSERA_OK : TESSERA_BUS;
}

static int write_register(struct tessera_driver* driver, uint32_t offset, uint32_t value) {
    uint32_t status = 0;
    if (driver->platform.write32(driver->platform.context, offset, value) == 0)
        return TESSERA_OK;
    return read_register(driver, TESSERA_STATUS, &status) == TESSERA_OK && (status & TESSERA_STATUS_BUSY) != 0
               ? TESSERA_BUSY
               : TESSERA_BUS;
}

static int write_value(struct tessera_driver* driver, const struct register_info* info, uint64_t value) {
    const int result = write_register(driver, info->offset, (uint32_t)(value & 0xffffffffu));
    return result != TESSERA_OK || info->words == 1 ? result
                                                    : write_register(driver, info->offset + 4, (uint32_t)(value >> 32));
}

/* Takes up the ring of the device's registers. */
static int take_up_ring(struct tessera_driver* driver) {
    uint32_t low = 0, high = 0;
    int result = read_register(driver, TESSERA_RING_ADDRESS, &low);
    if (result == TESSERA_OK)
        result = read_register(driver, TESSERA_RING_ADDRESS + 4, &high);
    if (result == TESSERA_OK)
        result = read_register(driver, TESSERA_RING_SIZE, &driver->ring_size);
    if (result == TESSERA_OK)
        result = read_register(driver, TESSERA_RING_READ_INDEX, &driver->read_index);
    driver->ring_address = (uint64_t)high << 32 | low;
    driver->ring_place = driver->ring_size == 0 ? 0 : driver->read_index % driver->ring_size;
    return result;
}

/* Until none of `bits` is set in status. */
static int poll(struct tessera_driver* driver, uint32_t bits, uint32_t polls, uint32_t* status) {
    for (; polls > 0; --polls) {
        const int result = read_register(driver, TESSERA_STATUS, status);
        if (result != TESSERA_OK || (*status & bits) == 0)
            return result;
        if (driver->platform.pause != NULL)
            driver->platform.pause(driver->platform.context);
    }
    return TESSERA_TIMEOUT;
}

int tessera_init(struct tessera_driver* driver, const struct tessera_platform* platform) {
    uint32_t id = 0, version = 0;
    driver->platform = *platform;
    if (read_register(driver, TESSERA_ID, &id) != TESSERA_OK ||
        read_register(driver, TESSERA_VERSION, &version) != TESSERA_OK)
        return TESSERA_BUS;
    return id == 0x53534554u && version >> 16 == 1 ? take_up_ring(driver) : TESSERA_NO_DEVICE;
}

int tessera_reset(struct tessera_driver* driver, uint32_t polls) {
    uint32_t status = 0;
    int result = write_register(driver, TESSERA_CONTROL, TESSERA_CONTROL_RESET);
    if (result == TESSERA_OK)
        result = poll(driver, TESSERA_STATUS_BUSY, polls, &status);
    return result != TESSERA_OK ? result : take_up_ring(driver);
}

int tessera_set(struct tessera_driver* driver, enum tessera_register number, int64_t value) {
    const struct register_info* info = NULL;
    int64_t before = 0, stored = 0;
    int result;
    if ((unsigned)number >= TESSERA_REGISTERS)
        return TESSERA_NO_REGISTER;
    info = &register_infos[number];
    if (!info->writable)
        return TESSERA_READ_ONLY;
    if (number == TESSERA_REGISTER_CONTROL || number == TESSERA_REGISTER_INTERRUPT)
        return write_register(driver, info->offset, (uint32_t)value);
    result = tessera_get(driver, number, &before);
    if (result == TESSERA_OK)
        result = write_value(driver, info, (uint64_t)value);
    if (result == TESSERA_OK)
        result = tessera_get(driver, number, &stored);
    if (result != TESSERA_OK || stored == value)
        return result;
    result = write_value(driver, info, (uint64_t)before);
    return result != TESSERA_OK ? result : TESSERA_BAD_VALUE;
}

int tessera_get(struct tessera_driver* driver, enum tessera_register number, int64_t* value) {
    const struct register_info* info = NULL;
    uint32_t low = 0, high = 0;
    int result;
    if ((unsigned)number >= TESSERA_REGISTERS)
        return TESSERA_NO_REGISTER;
    info = &register_infos[number];
    result = read_register(driver, info->offset, &low);
    if (result == TESSERA_OK && info->words == 2)
        result = read_register(driver, info->offset + 4, &high);
    else if (info->is_signed && low >> 31 != 0)
        high = 0xffffffffu;
    *value = (int64_t)((uint64_t)high << 32 | low);
    return result;
}

const char* tessera_register_name(enum tessera_register number) {
    return (unsigned)number < TESSERA_REGISTERS ? register_infos[number].name : "no such register";
}

int tessera_set_tables(struct tessera_driver* driver, uint64_t displacement_map, uint64_t normal_map,
                       uint64_t summed_height_table) {
    int result = tessera_set(driver, TESSERA_REGISTER_DISPLACEMENT_MAP_ADDRESS, (int64_t)displacement_map);
    if (result == TESSERA_OK)
        result = tessera_set(driver, TESSERA_REGISTER_NORMAL_MAP_ADDRESS, (int64_t)normal_map);
    return result != TESSERA_OK
               ? result
               : tessera_set(driver, TESSERA_REGISTER_SUMMED_HEIGHT_TABLE_ADDRESS, (int64_t)summed_height_table);
}

int tessera_fetch_tables(struct tessera_driver* driver, uint32_t tables) {
    return tessera_set(driver, TESSERA_REGISTER_FETCH, tables);
}

int tessera_set_triangles(struct tessera_driver* driver, uint64_t address, uint32_t count) {
    const int result = tessera_set(driver, TESSERA_REGISTER_TRIANGLES_ADDRESS, (int64_t)address);
    return result != TESSERA_OK ? result : tessera_set(driver, TESSERA_REGISTER_TRIANGLES_COUNT, count);
}

int tessera_set_ring(struct tessera_driver* driver, uint64_t address, uint32_t records) {
    const int result = tessera_set(driver, TESSERA_REGISTER_RING_ADDRESS, (int64_t)address);
    return result != TESSERA_OK ? result : tessera_set(driver, TESSERA_REGISTER_RING_SIZE, records);
}

/* Whether a frame with this error was refused at its start, and changed nothing. */
static int is_refusal(int error) {
    return (error >= TESSERA_ERROR_BAD_VALUE && error <= TESSERA_ERROR_BAD_RING_SIZE) ||
           error == TESSERA_ERROR_NO_TABLE;
}

int tessera_start(struct tessera_driver* driver) {
    uint32_t status = 0;
    int error = 0, result = write_register(driver, TESSERA_CONTROL, TESSERA_CONTROL_START);
    if (result == TESSERA_OK)
        result = read_register(driver, TESSERA_STATUS, &status);
    if (result == TESSERA_OK && (status & TESSERA_STATUS_ERROR) != 0)
        error = tessera_last_error(driver, NULL);
    if (result != TESSERA_OK || is_refusal(error))
        return result != TESSERA_OK ? result : error;
    result = take_up_ring(driver);
    return result != TESSERA_OK ? result : error;
}

int tessera_status(struct tessera_driver* driver, uint32_t* status) {
    return read_register(driver, TESSERA_STATUS, status);
}

int tessera_wait(struct tessera_driver* driver, uint32_t polls) {
    uint32_t status = 0;
    const int result = poll(driver, TESSERA_STATUS_BUSY, polls, &status);
    if (result != TESSERA_OK || (status & TESSERA_STATUS_DONE) != 0)
        return result;
    return (status & TESSERA_STATUS_ERROR) != 0 ? tessera_last_error(driver, NULL) : TESSERA_NO_FRAME;
}

int tessera_enable_interrupts(struct tessera_driver* driver, uint32_t interrupts) {
    return tessera_set(driver, TESSERA_REGISTER_INTERRUPT_ENABLE, interrupts);
}

int tessera_acknowledge(struct tessera_driver* driver, uint32_t* interrupts) {
    const int result = read_register(driver, TESSERA_INTERRUPT, interrupts);
    return result != TESSERA_OK ? result : write_register(driver, TESSERA_INTERRUPT, *interrupts);
}

int tessera_ring_count(struct tessera_driver* driver, uint32_t* count) {
    uint32_t write_index = 0, read_index = 0;
    int result = read_register(driver, TESSERA_RING_READ_INDEX, &read_index);
    if (result == TESSERA_OK)
        result = read_register(driver, TESSERA_RING_WRITE_INDEX, &write_index);
    *count = write_index - read_index;
    if (read_index != driver->read_index && driver->ring_size > 0) { /* after a reset, or set by software */
        driver->read_index = read_index;
        driver->ring_place = read_index % driver->ring_size;
    }
    return result;
}

/* Why a record cannot be read. */
static int no_record(struct tessera_driver* driver) {
    uint32_t count = 0;
    return tessera_ring_count(driver, &count) == TESSERA_OK && count == 0 ? TESSERA_EMPTY : TESSERA_BUS;
}

int tessera_ring_pop(struct tessera_driver* driver, struct tessera_finished_triangle* triangle) {
    unsigned char bytes[sizeof *triangle];
    const uint64_t address = driver->ring_address + (uint64_t)driver->ring_place * sizeof bytes;
    size_t vertex, word;
    if (driver->platform.read_memory(driver->platform.context, address, bytes, sizeof bytes) != 0)
        return no_record(driver);
    for (vertex = 0; vertex < 3; ++vertex) {
        uint32_t words[6];
        struct tessera_finished_vertex* v = &triangle->vertices[vertex];
        for (word = 0; word < 6; ++word) {
            const unsigned char* b = bytes + 4 * (6 * vertex + word);
            words[word] = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
        }
        v->x = (int32_t)words[0];
        v->y = (int32_t)words[1];
        v->w = (int32_t)words[2];
        v->u = words[3];
        v->v = words[4];
        v->light = words[5];
    }
    if (driver->platform.write32(driver->platform.context, TESSERA_RING_READ_INDEX, driver->read_index + 1) != 0)
        return no_record(driver);
    ++driver->read_index;
    driver->ring_place = driver->ring_place + 1 == driver->ring_size ? 0 : driver->ring_place + 1;
    return TESSERA_OK;
}

int tessera_last_error(struct tessera_driver* driver, uint64_t* address) {
    uint32_t error = 0, low = 0, high = 0;
    if (read_register(driver, TESSERA_ERROR, &error) != TESSERA_OK ||
        read_register(driver, TESSERA_ERROR_ADDRESS, &low) != TESSERA_OK ||
        read_register(driver, TESSERA_ERROR_ADDRESS + 4, &high) != TESSERA_OK)
        return TESSERA_BUS;
    if (address != NULL)
        *address = (uint64_t)high << 32 | low;
    return (int)error;
}

const char* tessera_text(int result) {
    static const char* const own[] = {"no error",
                                      "the bus returned an error",
                                      "no such device",
                                      "still busy",
                                      "a read-only register",
                                      "no such register",
                                      "refused: a frame or a reset is in progress",
                                      "no frame was started, or it was reset",
                                      "no triangle waits in the ring",
                                      "the value does not fit the register"};
    static const char* const of_device[TESSERA_ERRORS] = {TESSERA_ERROR_TEXTS};
    if (result > 0 && result < TESSERA_ERRORS)
        return of_device[result];
    return result <= 0 && result >= TESSERA_BAD_VALUE ? own[-result] : "unknown error";
}
