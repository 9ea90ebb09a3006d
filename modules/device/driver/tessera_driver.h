#pragma once
/* A driver of tessera's device, in C99. It allocates nothing, keeps no global state, and reaches the device through the
 * caller's functions alone. modules/device/README.md has an example. */
/* NOLINTBEGIN(readability-identifier-naming,modernize-deprecated-headers): C's names and headers */
#include <stddef.h>
#include <stdint.h>

#include "modules/device/generated/tessera_registers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the driver needs of a platform. Each function returns 0, or anything else if the bus answered by an error. */
struct tessera_platform {
    void* context;                                                  /* passed to each function */
    int (*read32)(void* context, uint32_t offset, uint32_t* value); /* of the device's registers */
    int (*write32)(void* context, uint32_t offset, uint32_t value);
    int (*read_memory)(void* context, uint64_t address, unsigned char* bytes, size_t count);
    void (*pause)(void* context); /* after a poll that found the device busy: waits for a while; may be null */
};

struct tessera_driver {
    struct tessera_platform platform;
    uint64_t ring_address; /* of the last frame */
    uint32_t ring_size;    /* records */
    uint32_t ring_place;   /* of the next record to be read */
    uint32_t read_index;
};

/* Results. A positive one is the device's error, enum tessera_error. */
enum tessera_result {
    TESSERA_OK = 0,
    TESSERA_BUS = -1,         /* the bus, or the device, answered an access by an error */
    TESSERA_NO_DEVICE = -2,   /* no such device, or a register map of another major version */
    TESSERA_TIMEOUT = -3,     /* still busy after all polls */
    TESSERA_READ_ONLY = -4,   /* such a register cannot be set */
    TESSERA_NO_REGISTER = -5, /* there is none of that number */
    TESSERA_BUSY = -6,        /* refused: a frame, or a reset, is under way */
    TESSERA_NO_FRAME = -7,    /* no frame was started, or it was reset */
    TESSERA_EMPTY = -8,       /* no triangle waits in the ring */
    TESSERA_BAD_VALUE = -9    /* does not fit the register, which keeps its value */
};

/* Identifies the device, and takes up its ring where it is. To be called first; it changes nothing. */
int tessera_init(struct tessera_driver* driver, const struct tessera_platform* platform);
/* Resets the device and waits until it is empty. */
int tessera_reset(struct tessera_driver* driver, uint32_t polls);

/* A register by its number, TESSERA_REGISTER_...; of two words the lower one first. Signed ones are extended. */
int tessera_set(struct tessera_driver* driver, enum tessera_register number, int64_t value);
int tessera_get(struct tessera_driver* driver, enum tessera_register number, int64_t* value);
const char* tessera_register_name(enum tessera_register number);

/* Bus addresses of a frame's inputs and outputs. */
int tessera_set_tables(struct tessera_driver* driver, uint64_t displacement_map, uint64_t normal_map,
                       uint64_t summed_height_table);
/* Which tables the next frames fetch: TESSERA_FETCH_... */
int tessera_fetch_tables(struct tessera_driver* driver, uint32_t tables);
int tessera_set_triangles(struct tessera_driver* driver, uint64_t address, uint32_t count);
/* From the next start on; records of the last frame that are not read by then are lost. */
int tessera_set_ring(struct tessera_driver* driver, uint64_t address, uint32_t records);

/* Begins a frame. A frame that the device refuses gives its error at once; the last one's records may still be read. */
int tessera_start(struct tessera_driver* driver);
/* TESSERA_STATUS_...  */
int tessera_status(struct tessera_driver* driver, uint32_t* status);
/* Until the frame is complete, or has failed: the device's error, or TESSERA_NO_FRAME. The ring must be large enough, or
 * read meanwhile. */
int tessera_wait(struct tessera_driver* driver, uint32_t polls);

/* TESSERA_INTERRUPT_... */
int tessera_enable_interrupts(struct tessera_driver* driver, uint32_t interrupts);
/* Clears the pending interrupts, and says which they were. */
int tessera_acknowledge(struct tessera_driver* driver, uint32_t* interrupts);

/* Finished triangles that wait in the ring. */
int tessera_ring_count(struct tessera_driver* driver, uint32_t* count);
/* Reads the oldest, and frees its place. */
int tessera_ring_pop(struct tessera_driver* driver, struct tessera_finished_triangle* triangle);

/* Why the last frame was refused or stopped, and where. */
int tessera_last_error(struct tessera_driver* driver, uint64_t* address);
/* Of a result of any of these functions. */
const char* tessera_text(int result);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(readability-identifier-naming,modernize-deprecated-headers) */
