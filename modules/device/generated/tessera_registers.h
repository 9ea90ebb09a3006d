#pragma once
/* clang-format off */
/* NOLINTBEGIN(readability-identifier-naming,modernize-deprecated-headers): C's */
/* Registers and records of tessera's device.
 * Generated from modules/device/register_map.cpp; do not edit.
 * Offsets are the same in every design; widths are those of the default formats. */
#include <stdint.h>

/* Offsets in bytes. In a two-word register the lower word comes first. */
#define TESSERA_ID 0x000u
#define TESSERA_VERSION 0x004u
#define TESSERA_CONTROL 0x008u
#define TESSERA_STATUS 0x00cu
#define TESSERA_INTERRUPT 0x010u
#define TESSERA_INTERRUPT_ENABLE 0x014u
#define TESSERA_ERROR 0x018u
#define TESSERA_ERROR_ADDRESS 0x020u
#define TESSERA_FETCH 0x028u
#define TESSERA_DISPLACEMENT_MAP_ADDRESS 0x030u
#define TESSERA_NORMAL_MAP_ADDRESS 0x038u
#define TESSERA_SUMMED_HEIGHT_TABLE_ADDRESS 0x040u
#define TESSERA_TRIANGLES_ADDRESS 0x048u
#define TESSERA_TRIANGLES_COUNT 0x050u
#define TESSERA_TRIANGLES_SENT 0x054u
#define TESSERA_TRIANGLES_FINISHED 0x058u
#define TESSERA_RING_ADDRESS 0x060u
#define TESSERA_RING_SIZE 0x068u
#define TESSERA_RING_WRITE_INDEX 0x06cu
#define TESSERA_RING_READ_INDEX 0x070u
#define TESSERA_FORMAT_POSITION 0x080u
#define TESSERA_FORMAT_NORMAL 0x084u
#define TESSERA_FORMAT_TEXTURE 0x088u
#define TESSERA_FORMAT_DISPLACEMENT 0x08cu
#define TESSERA_FORMAT_SUMMED_HEIGHT 0x090u
#define TESSERA_FORMAT_SCREEN 0x094u
#define TESSERA_FEATURES 0x098u
#define TESSERA_LARGEST_MAP 0x09cu
#define TESSERA_ENTRY_BYTES 0x0a0u
#define TESSERA_RECORD_BYTES 0x0a4u
#define TESSERA_MAP_ADDRESS_U 0x100u
#define TESSERA_MAP_ADDRESS_V 0x104u
#define TESSERA_TESTS_NORMAL_TEST 0x108u
#define TESSERA_TESTS_SUMMED_HEIGHT_TEST 0x10cu
#define TESSERA_TESTS_SUMMED_HEIGHT_UNIT 0x110u
#define TESSERA_TESTS_VIEW_TEST 0x114u
#define TESSERA_TESTS_TEX_COORD_TEST 0x118u
#define TESSERA_TESTS_GENERATION_TEST 0x11cu
#define TESSERA_TRIANGULATION 0x120u
#define TESSERA_BACK_FACE_CULLING 0x124u
#define TESSERA_MAP_WIDTH 0x128u
#define TESSERA_MAP_HEIGHT 0x12cu
#define TESSERA_DISPLACEMENT_MAP_BASE 0x130u
#define TESSERA_NORMAL_MAP_BASE 0x138u
#define TESSERA_SUMMED_HEIGHT_TABLE_BASE 0x140u
#define TESSERA_TESTS_NORMAL_THRESHOLD 0x148u
#define TESSERA_TESTS_SUMMED_HEIGHT_THRESHOLD 0x150u
#define TESSERA_TESTS_VIEW_THRESHOLD 0x158u
#define TESSERA_TESTS_GENERATION_LIMIT 0x15cu
#define TESSERA_TESTS_HIGHLIGHT_TEST 0x160u
#define TESSERA_TESTS_HALF_VECTOR_0 0x164u
#define TESSERA_TESTS_HALF_VECTOR_1 0x168u
#define TESSERA_TESTS_HALF_VECTOR_2 0x16cu
#define TESSERA_TESTS_HIGHLIGHT_COSINE 0x170u
#define TESSERA_TESTS_HIGHLIGHT_NORMAL_THRESHOLD 0x178u
#define TESSERA_DISPLACEMENT_SCALE 0x17cu
#define TESSERA_DISPLACEMENT_BIAS 0x180u
#define TESSERA_TRANSFORM_ROW_X_0 0x184u
#define TESSERA_TRANSFORM_ROW_X_1 0x188u
#define TESSERA_TRANSFORM_ROW_X_2 0x18cu
#define TESSERA_TRANSFORM_ROW_X_OFFSET 0x190u
#define TESSERA_TRANSFORM_ROW_Y_0 0x198u
#define TESSERA_TRANSFORM_ROW_Y_1 0x19cu
#define TESSERA_TRANSFORM_ROW_Y_2 0x1a0u
#define TESSERA_TRANSFORM_ROW_Y_OFFSET 0x1a8u
#define TESSERA_TRANSFORM_ROW_W_0 0x1b0u
#define TESSERA_TRANSFORM_ROW_W_1 0x1b4u
#define TESSERA_TRANSFORM_ROW_W_2 0x1b8u
#define TESSERA_TRANSFORM_ROW_W_OFFSET 0x1c0u
#define TESSERA_TRANSFORM_EXPONENT 0x1c8u
#define TESSERA_TRANSFORM_VIEW_DISTANCE_SHIFT 0x1ccu
#define TESSERA_TRANSFORM_NEAR_PLANE 0x1d0u
#define TESSERA_TRANSFORM_NORMAL_ROWS_0 0x1d8u
#define TESSERA_TRANSFORM_NORMAL_ROWS_1 0x1dcu
#define TESSERA_TRANSFORM_NORMAL_ROWS_2 0x1e0u
#define TESSERA_TRANSFORM_NORMAL_ROWS_3 0x1e4u
#define TESSERA_TRANSFORM_NORMAL_ROWS_4 0x1e8u
#define TESSERA_TRANSFORM_NORMAL_ROWS_5 0x1ecu
#define TESSERA_TRANSFORM_NORMAL_ROWS_6 0x1f0u
#define TESSERA_TRANSFORM_NORMAL_ROWS_7 0x1f4u
#define TESSERA_TRANSFORM_NORMAL_ROWS_8 0x1f8u
#define TESSERA_LIGHT_DIRECTION_0 0x1fcu
#define TESSERA_LIGHT_DIRECTION_1 0x200u
#define TESSERA_LIGHT_DIRECTION_2 0x204u
#define TESSERA_LIGHT_AMBIENT 0x208u
#define TESSERA_RANK_TABLE_COLUMNS 0x20cu
#define TESSERA_RANK_TABLE_ROWS 0x210u
#define TESSERA_TESTS_RANK_THRESHOLD 0x214u
#define TESSERA_TESTS_BOUND_THRESHOLD 0x218u
#define TESSERA_TESTS_RANK_PER_PIXEL 0x21cu
#define TESSERA_TRANSFORM_EYE_0 0x220u
#define TESSERA_TRANSFORM_EYE_1 0x228u
#define TESSERA_TRANSFORM_EYE_2 0x230u
#define TESSERA_CURVATURE_TABLE_COLUMNS 0x238u
#define TESSERA_CURVATURE_TABLE_ROWS 0x23cu
#define TESSERA_TESTS_CURVATURE_THRESHOLD 0x240u
#define TESSERA_TESTS_MIPMAP_THRESHOLD 0x248u
#define TESSERA_REGISTER_BYTES 0x400u

/* Bits of control registers. */
#define TESSERA_CONTROL_START (1u << 0)  /* starts a frame */
#define TESSERA_CONTROL_RESET (1u << 1)  /* stops a frame and sets all registers to their reset values */
#define TESSERA_STATUS_BUSY (1u << 0)  /* a frame is being processed, or a reset is waiting for the machine to drain */
#define TESSERA_STATUS_DONE (1u << 1)  /* the last frame is complete: all its triangles are in memory */
#define TESSERA_STATUS_ERROR (1u << 2)  /* the last frame was refused or stopped: see error */
#define TESSERA_STATUS_RESETTING (1u << 3)  /* a reset is in progress */
#define TESSERA_INTERRUPT_DONE (1u << 0)  /* a frame was completed */
#define TESSERA_INTERRUPT_ERROR (1u << 1)  /* a frame was refused or stopped */
#define TESSERA_FETCH_DISPLACEMENT_MAP (1u << 0)  /* the next frame fetches this table */
#define TESSERA_FETCH_NORMAL_MAP (1u << 1)  /* the next frame fetches this table */
#define TESSERA_FETCH_SUMMED_HEIGHT_TABLE (1u << 2)  /* the next frame fetches this table */
#define TESSERA_FEATURES_HIGHLIGHT (1u << 0)  /* a Highlight Test */
#define TESSERA_FEATURES_FINAL_EDGES (1u << 1)  /* queue entries mark final edges */
#define TESSERA_FEATURES_CODES (1u << 2)  /* vertices carry displacement codes */
#define TESSERA_FEATURES_FAMILIES (1u << 3)  /* the family design */
#define TESSERA_FEATURES_BILINEAR (1u << 4)  /* bilinear filter for the maps */
#define TESSERA_FEATURES_RANK_TEST (1u << 5)  /* a Rank Test in place of the Summed Height Test */
#define TESSERA_FEATURES_CURVATURE_TEST (1u << 6)  /* a Curvature Test in place of the Summed Height Test */
#define TESSERA_FEATURES_DISTANCES (1u << 7)  /* a view-dependent Rank Test */
#define TESSERA_FEATURES_MIPMAP_TEST (1u << 12)  /* a Mipmap Test in place of the Summed Height Test */

/* Register `error`. */
enum tessera_error {
    TESSERA_ERROR_NONE = 0,  /* no error */
    TESSERA_ERROR_BAD_VALUE = 1,  /* refused: an invalid register value; the register's offset */
    TESSERA_ERROR_BAD_MAP_SIZE = 2,  /* refused: an empty map, or one larger than the device supports; the register's offset */
    TESSERA_ERROR_BAD_ADDRESS = 3,  /* refused: an address that is not a multiple of 4, or data that extend beyond 2^64; the register's offset */
    TESSERA_ERROR_BAD_RING_SIZE = 4,  /* refused: a ring of size 0; the register's offset */
    TESSERA_ERROR_TABLE_READ = 5,  /* stopped: bus error on a read of a table; the address */
    TESSERA_ERROR_TRIANGLE_READ = 6,  /* stopped: bus error on a read of a base triangle; the address */
    TESSERA_ERROR_BAD_TRIANGLE = 7,  /* stopped: a value of a base triangle does not fit its format; the record's address */
    TESSERA_ERROR_RING_WRITE = 8,  /* stopped: bus error on a write to the ring; the address */
    TESSERA_ERROR_QUEUE_FULL = 9,  /* stopped: the waiting triangles would not fit the Triangle Queue's memory; 0 */
    TESSERA_ERROR_MACHINE_STOPPED = 10,  /* refused or stopped: the machine's clock has halted, and a reset has no effect; 0 */
    TESSERA_ERROR_TABLE_MEMORY = 11,  /* stopped: a memory outside the machine refused a table, or was changed by another; the bus address of the refused data, or 0 */
    TESSERA_ERROR_NO_TABLE = 12,  /* refused: a table that is not to be fetched and never was, whole and in this size; the register's offset */
};
#define TESSERA_ERRORS 13
#define TESSERA_ERROR_TEXTS \
    "no error", \
    "refused: an invalid register value; the register's offset", \
    "refused: an empty map, or one larger than the device supports; the register's offset", \
    "refused: an address that is not a multiple of 4, or data that extend beyond 2^64; the register's offset", \
    "refused: a ring of size 0; the register's offset", \
    "stopped: bus error on a read of a table; the address", \
    "stopped: bus error on a read of a base triangle; the address", \
    "stopped: a value of a base triangle does not fit its format; the record's address", \
    "stopped: bus error on a write to the ring; the address", \
    "stopped: the waiting triangles would not fit the Triangle Queue's memory; 0", \
    "refused or stopped: the machine's clock has halted, and a reset has no effect; 0", \
    "stopped: a memory outside the machine refused a table, or was changed by another; the bus address of the refused data, or 0", \
    "refused: a table that is not to be fetched and never was, whole and in this size; the register's offset"

/* Records in bus memory: little-endian words. */
struct tessera_base_vertex {
    int32_t px;  /* P, position's format */
    int32_t py;
    int32_t pz;
    int32_t nx;  /* N, normal's format; no component beyond 1.0 in magnitude */
    int32_t ny;
    int32_t nz;
    int32_t tx;  /* T, same format and limit as N */
    int32_t ty;
    int32_t tz;
    int32_t handedness;  /* 1 or -1: bitangent = handedness (N x T) */
    uint32_t u;  /* t in texels, texture's format: at most 2^integer */
    uint32_t v;
};
struct tessera_base_triangle {
    struct tessera_base_vertex vertices[3];
};
struct tessera_finished_vertex {
    int32_t x;  /* P's in pixels, screen's format */
    int32_t y;
    int32_t w;  /* distance from the eye, in the view distance's format */
    uint32_t u;  /* t in texels, texture's format */
    uint32_t v;
    uint32_t light;  /* bits 7 to 0: intensity; bit 8: in front of the near plane */
};
struct tessera_finished_triangle {
    struct tessera_finished_vertex vertices[3];
};

/* X(name, offset, bits, words, is signed, writable) for every register. */
#define TESSERA_REGISTER_LIST(X) \
    X(ID, 0x000u, 32, 1, 0, 0) \
    X(VERSION, 0x004u, 32, 1, 0, 0) \
    X(CONTROL, 0x008u, 2, 1, 0, 1) \
    X(STATUS, 0x00cu, 4, 1, 0, 0) \
    X(INTERRUPT, 0x010u, 2, 1, 0, 1) \
    X(INTERRUPT_ENABLE, 0x014u, 2, 1, 0, 1) \
    X(ERROR, 0x018u, 4, 1, 0, 0) \
    X(ERROR_ADDRESS, 0x020u, 64, 2, 0, 0) \
    X(FETCH, 0x028u, 3, 1, 0, 1) \
    X(DISPLACEMENT_MAP_ADDRESS, 0x030u, 64, 2, 0, 1) \
    X(NORMAL_MAP_ADDRESS, 0x038u, 64, 2, 0, 1) \
    X(SUMMED_HEIGHT_TABLE_ADDRESS, 0x040u, 64, 2, 0, 1) \
    X(TRIANGLES_ADDRESS, 0x048u, 64, 2, 0, 1) \
    X(TRIANGLES_COUNT, 0x050u, 32, 1, 0, 1) \
    X(TRIANGLES_SENT, 0x054u, 32, 1, 0, 0) \
    X(TRIANGLES_FINISHED, 0x058u, 32, 1, 0, 0) \
    X(RING_ADDRESS, 0x060u, 64, 2, 0, 1) \
    X(RING_SIZE, 0x068u, 31, 1, 0, 1) \
    X(RING_WRITE_INDEX, 0x06cu, 32, 1, 0, 0) \
    X(RING_READ_INDEX, 0x070u, 32, 1, 0, 1) \
    X(FORMAT_POSITION, 0x080u, 16, 1, 0, 0) \
    X(FORMAT_NORMAL, 0x084u, 16, 1, 0, 0) \
    X(FORMAT_TEXTURE, 0x088u, 16, 1, 0, 0) \
    X(FORMAT_DISPLACEMENT, 0x08cu, 16, 1, 0, 0) \
    X(FORMAT_SUMMED_HEIGHT, 0x090u, 16, 1, 0, 0) \
    X(FORMAT_SCREEN, 0x094u, 16, 1, 0, 0) \
    X(FEATURES, 0x098u, 16, 1, 0, 0) \
    X(LARGEST_MAP, 0x09cu, 32, 1, 0, 0) \
    X(ENTRY_BYTES, 0x0a0u, 24, 1, 0, 0) \
    X(RECORD_BYTES, 0x0a4u, 32, 1, 0, 0) \
    X(MAP_ADDRESS_U, 0x100u, 1, 1, 0, 1) \
    X(MAP_ADDRESS_V, 0x104u, 1, 1, 0, 1) \
    X(TESTS_NORMAL_TEST, 0x108u, 1, 1, 0, 1) \
    X(TESTS_SUMMED_HEIGHT_TEST, 0x10cu, 1, 1, 0, 1) \
    X(TESTS_SUMMED_HEIGHT_UNIT, 0x110u, 1, 1, 0, 1) \
    X(TESTS_VIEW_TEST, 0x114u, 1, 1, 0, 1) \
    X(TESTS_TEX_COORD_TEST, 0x118u, 1, 1, 0, 1) \
    X(TESTS_GENERATION_TEST, 0x11cu, 1, 1, 0, 1) \
    X(TRIANGULATION, 0x120u, 2, 1, 0, 1) \
    X(BACK_FACE_CULLING, 0x124u, 1, 1, 0, 1) \
    X(MAP_WIDTH, 0x128u, 13, 1, 0, 1) \
    X(MAP_HEIGHT, 0x12cu, 13, 1, 0, 1) \
    X(DISPLACEMENT_MAP_BASE, 0x130u, 64, 2, 0, 0) \
    X(NORMAL_MAP_BASE, 0x138u, 64, 2, 0, 0) \
    X(SUMMED_HEIGHT_TABLE_BASE, 0x140u, 64, 2, 0, 0) \
    X(TESTS_NORMAL_THRESHOLD, 0x148u, 16, 1, 0, 1) \
    X(TESTS_SUMMED_HEIGHT_THRESHOLD, 0x150u, 51, 2, 0, 1) \
    X(TESTS_VIEW_THRESHOLD, 0x158u, 25, 1, 0, 1) \
    X(TESTS_GENERATION_LIMIT, 0x15cu, 4, 1, 0, 1) \
    X(TESTS_HIGHLIGHT_TEST, 0x160u, 1, 1, 0, 1) \
    X(TESTS_HALF_VECTOR_0, 0x164u, 16, 1, 1, 1) \
    X(TESTS_HALF_VECTOR_1, 0x168u, 16, 1, 1, 1) \
    X(TESTS_HALF_VECTOR_2, 0x16cu, 16, 1, 1, 1) \
    X(TESTS_HIGHLIGHT_COSINE, 0x170u, 30, 2, 1, 1) \
    X(TESTS_HIGHLIGHT_NORMAL_THRESHOLD, 0x178u, 16, 1, 0, 1) \
    X(DISPLACEMENT_SCALE, 0x17cu, 32, 1, 1, 1) \
    X(DISPLACEMENT_BIAS, 0x180u, 32, 1, 1, 1) \
    X(TRANSFORM_ROW_X_0, 0x184u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_X_1, 0x188u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_X_2, 0x18cu, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_X_OFFSET, 0x190u, 63, 2, 1, 1) \
    X(TRANSFORM_ROW_Y_0, 0x198u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_Y_1, 0x19cu, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_Y_2, 0x1a0u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_Y_OFFSET, 0x1a8u, 63, 2, 1, 1) \
    X(TRANSFORM_ROW_W_0, 0x1b0u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_W_1, 0x1b4u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_W_2, 0x1b8u, 26, 1, 1, 1) \
    X(TRANSFORM_ROW_W_OFFSET, 0x1c0u, 63, 2, 1, 1) \
    X(TRANSFORM_EXPONENT, 0x1c8u, 5, 1, 0, 1) \
    X(TRANSFORM_VIEW_DISTANCE_SHIFT, 0x1ccu, 5, 1, 0, 1) \
    X(TRANSFORM_NEAR_PLANE, 0x1d0u, 63, 2, 0, 1) \
    X(TRANSFORM_NORMAL_ROWS_0, 0x1d8u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_1, 0x1dcu, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_2, 0x1e0u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_3, 0x1e4u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_4, 0x1e8u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_5, 0x1ecu, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_6, 0x1f0u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_7, 0x1f4u, 16, 1, 1, 1) \
    X(TRANSFORM_NORMAL_ROWS_8, 0x1f8u, 16, 1, 1, 1) \
    X(LIGHT_DIRECTION_0, 0x1fcu, 16, 1, 1, 1) \
    X(LIGHT_DIRECTION_1, 0x200u, 16, 1, 1, 1) \
    X(LIGHT_DIRECTION_2, 0x204u, 16, 1, 1, 1) \
    X(LIGHT_AMBIENT, 0x208u, 9, 1, 0, 1) \
    X(RANK_TABLE_COLUMNS, 0x20cu, 13, 1, 0, 1) \
    X(RANK_TABLE_ROWS, 0x210u, 13, 1, 0, 1) \
    X(TESTS_RANK_THRESHOLD, 0x214u, 19, 1, 1, 1) \
    X(TESTS_BOUND_THRESHOLD, 0x218u, 18, 1, 1, 1) \
    X(TESTS_RANK_PER_PIXEL, 0x21cu, 1, 1, 0, 1) \
    X(TRANSFORM_EYE_0, 0x220u, 40, 2, 1, 1) \
    X(TRANSFORM_EYE_1, 0x228u, 40, 2, 1, 1) \
    X(TRANSFORM_EYE_2, 0x230u, 40, 2, 1, 1) \
    X(CURVATURE_TABLE_COLUMNS, 0x238u, 13, 1, 0, 1) \
    X(CURVATURE_TABLE_ROWS, 0x23cu, 13, 1, 0, 1) \
    X(TESTS_CURVATURE_THRESHOLD, 0x240u, 37, 2, 0, 1) \
    X(TESTS_MIPMAP_THRESHOLD, 0x248u, 17, 1, 0, 1)

/* Numbers of the registers: their positions in that list. */
enum tessera_register {
#define TESSERA_NUMBER(name, offset, bits, words, is_signed, writable) TESSERA_REGISTER_##name,
    TESSERA_REGISTER_LIST(TESSERA_NUMBER)
#undef TESSERA_NUMBER
    TESSERA_REGISTERS  /* number of registers */
};
/* NOLINTEND(readability-identifier-naming,modernize-deprecated-headers) */
