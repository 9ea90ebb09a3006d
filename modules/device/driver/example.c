#include "modules/device/driver/example.h"

/* Three frames, each with half the displacement of the one before. */
int draw_three_frames(const struct tessera_platform* platform, const struct example_scene* scene) {
    struct tessera_driver driver;
    int64_t scale = 0;
    int frame, result = tessera_init(&driver, platform);
    if (result != TESSERA_OK)
        return result;
    tessera_set_tables(&driver, scene->displacement_map, scene->normal_map, scene->summed_height_table);
    tessera_set_triangles(&driver, scene->triangles, scene->triangle_count);
    tessera_set_ring(&driver, scene->ring, scene->ring_records);
    tessera_get(&driver, TESSERA_REGISTER_DISPLACEMENT_SCALE, &scale);
    for (frame = 0; frame < 3 && result == TESSERA_OK; ++frame) {
        tessera_set(&driver, TESSERA_REGISTER_DISPLACEMENT_SCALE, scale / (1 << frame));
        tessera_fetch_tables(&driver, frame == 0 ? 7 : 0); /* all of them, then none */
        result = tessera_start(&driver);
        while (result == TESSERA_OK || result == TESSERA_TIMEOUT) {
            struct tessera_finished_triangle triangle;
            uint32_t count = 0;
            result = tessera_wait(&driver, 1);
            for (tessera_ring_count(&driver, &count); count > 0; --count) {
                tessera_ring_pop(&driver, &triangle);
                scene->draw(scene->drawing, frame, &triangle);
            }
            if (result == TESSERA_OK)
                break;
        }
    }
    return result; /* tessera_text() has it in words */
}
