#pragma once
/* The example of modules/device/README.md. */
#include "modules/device/driver/tessera_driver.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bus addresses of what the frames need, and the function that takes their triangles. */
struct example_scene { /* NOLINT(readability-identifier-naming): C's names */
    uint64_t displacement_map, normal_map, summed_height_table, triangles, ring;
    uint32_t triangle_count, ring_records;
    void* drawing;
    void (*draw)(void* drawing, int frame, const struct tessera_finished_triangle* triangle);
};

int draw_three_frames(const struct tessera_platform* platform, const struct example_scene* scene);

#ifdef __cplusplus
}
#endif
