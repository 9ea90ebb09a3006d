#include <array>
#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "modules/device/driver/example.h"
#include "modules/device/driver/tessera_driver.h"
#include "modules/device/register_map.h"

// The driver, with an array of words as the device.

using namespace tessera;

namespace {

struct Words {
    std::array<std::uint32_t, register_bytes / 4> words{};
    unsigned accesses = 0;
    unsigned failing = ~0u;  // of the accesses: the first that fails
    unsigned failures = 1;   // in succession
    unsigned pauses = 0;

    Words() {
        words[0] = 0x53534554;
        words[1] = 0x00010007;
    }
    bool fails() { return accesses++ - failing < failures; }
    tessera_platform platform() {
        return {this,
                [](void* self, std::uint32_t offset, std::uint32_t* value) {
                    auto* me = static_cast<Words*>(self);
                    *value = me->words.at(offset / 4);
                    return me->fails() ? 1 : 0;
                },
                [](void* self, std::uint32_t offset, std::uint32_t value) {
                    auto* me = static_cast<Words*>(self);
                    if (me->fails())
                        return 1;
                    me->words.at(offset / 4) = value;
                    return 0;
                },
                [](void* self, std::uint64_t address, unsigned char* bytes, std::size_t count) {
                    for (std::size_t k = 0; k < count; ++k)
                        bytes[k] = static_cast<unsigned char>(address + k);
                    return static_cast<Words*>(self)->fails() ? 1 : 0;
                },
                [](void* self) { ++static_cast<Words*>(self)->pauses; }};
    }
    tessera_driver driver() {
        const tessera_platform its = platform();
        tessera_driver result;
        REQUIRE(tessera_init(&result, &its) == TESSERA_OK);
        return result;
    }
};

}  // namespace

TEST_CASE("driver: it identifies the device and its register map") {
    Words device;
    const tessera_platform platform = device.platform();
    tessera_driver driver;
    CHECK(tessera_init(&driver, &platform) == TESSERA_OK);
    device.words[1] = 0x00020000;
    CHECK(tessera_init(&driver, &platform) == TESSERA_NO_DEVICE);
    device.words[1] = 0x00010000;
    device.words[0] = 0;
    CHECK(tessera_init(&driver, &platform) == TESSERA_NO_DEVICE);
}

TEST_CASE("driver: registers of one and two words, signed and unsigned, read-only and absent") {
    Words device;
    tessera_driver driver = device.driver();
    std::int64_t value = 0;
    CHECK(tessera_set(&driver, TESSERA_REGISTER_TRANSFORM_ROW_X_OFFSET, -5) == TESSERA_OK);
    CHECK(device.words[TESSERA_TRANSFORM_ROW_X_OFFSET / 4] == 0xfffffffb);
    CHECK(device.words[TESSERA_TRANSFORM_ROW_X_OFFSET / 4 + 1] == 0xffffffff);
    CHECK(tessera_get(&driver, TESSERA_REGISTER_TRANSFORM_ROW_X_OFFSET, &value) == TESSERA_OK);
    CHECK(value == -5);
    CHECK(tessera_set(&driver, TESSERA_REGISTER_LIGHT_DIRECTION_2, -7) == TESSERA_OK);
    CHECK(tessera_get(&driver, TESSERA_REGISTER_LIGHT_DIRECTION_2, &value) == TESSERA_OK);
    CHECK(value == -7);
    CHECK(tessera_set(&driver, TESSERA_REGISTER_RING_READ_INDEX, 0xfffffff0) == TESSERA_OK);
    CHECK(tessera_get(&driver, TESSERA_REGISTER_RING_READ_INDEX, &value) == TESSERA_OK);
    CHECK(value == 0xfffffff0);
    CHECK(tessera_set(&driver, TESSERA_REGISTER_ID, 1) == TESSERA_READ_ONLY);
    CHECK(tessera_set(&driver, TESSERA_REGISTERS, 1) == TESSERA_NO_REGISTER);
    CHECK(tessera_get(&driver, TESSERA_REGISTERS, &value) == TESSERA_NO_REGISTER);
    CHECK(std::string(tessera_register_name(TESSERA_REGISTER_TESTS_HALF_VECTOR_0)) == "TESTS_HALF_VECTOR_0");
    CHECK(std::string(tessera_register_name(TESSERA_REGISTERS)) == "no such register");
}

TEST_CASE("driver: it polls up to the limit, and pauses between polls") {
    Words device;
    tessera_driver driver = device.driver();
    device.words[offset::status / 4] = TESSERA_STATUS_BUSY;
    CHECK(tessera_wait(&driver, 3) == TESSERA_TIMEOUT);
    CHECK(device.pauses == 3);
    CHECK(tessera_reset(&driver, 2) == TESSERA_TIMEOUT);
    device.words[offset::status / 4] = TESSERA_STATUS_ERROR;
    device.words[offset::error / 4] = TESSERA_ERROR_TABLE_READ;
    CHECK(tessera_wait(&driver, 3) == TESSERA_ERROR_TABLE_READ);
    CHECK(tessera_start(&driver) == TESSERA_ERROR_TABLE_READ);
    device.words[offset::status / 4] = TESSERA_STATUS_DONE;
    CHECK(tessera_wait(&driver, 1) == TESSERA_OK);
    device.words[offset::status / 4] = 0;
    CHECK(tessera_wait(&driver, 1) == TESSERA_NO_FRAME);
}

TEST_CASE("driver: the ring's records are read in order, and word by word") {
    Words device;
    tessera_driver driver = device.driver();
    REQUIRE(tessera_set_ring(&driver, 0x1000, 2) == TESSERA_OK);
    REQUIRE(tessera_start(&driver) == TESSERA_OK);
    device.words[offset::ring_write_index / 4] = 3;
    std::uint32_t count = 0;
    CHECK(tessera_ring_count(&driver, &count) == TESSERA_OK);
    CHECK(count == 3);
    for (const std::uint32_t first : {0x03020100u, 0x4b4a4948u, 0x03020100u}) {
        tessera_finished_triangle triangle;
        CHECK(tessera_ring_pop(&driver, &triangle) == TESSERA_OK);
        CHECK(static_cast<std::uint32_t>(triangle.vertices[0].x) == first);
        CHECK(triangle.vertices[1].y == static_cast<std::int32_t>(first + 7 * 0x04040404));
    }
    CHECK(device.words[offset::ring_read_index / 4] == 3);
    CHECK(tessera_ring_count(&driver, &count) == TESSERA_OK);
    CHECK(count == 0);
}

TEST_CASE("driver: every function returns a bus error in any of its accesses") {
    const auto use = [](unsigned failing) {
        Words device;
        device.failing = failing;
        device.words[offset::status / 4] = TESSERA_STATUS_DONE;
        device.words[offset::ring_write_index / 4] = 1;
        const tessera_platform platform = device.platform();
        tessera_driver driver;
        std::int64_t value = 0;
        std::uint64_t address = 0;
        std::uint32_t word = 0;
        tessera_finished_triangle triangle;
        unsigned errors = 0;
        for (const int result :
             {tessera_init(&driver, &platform), tessera_reset(&driver, 1), tessera_set_tables(&driver, 4, 8, 12),
              tessera_fetch_tables(&driver, 7), tessera_set_triangles(&driver, 4, 1), tessera_set_ring(&driver, 4, 1),
              tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH, 1),
              tessera_get(&driver, TESSERA_REGISTER_ERROR_ADDRESS, &value), tessera_enable_interrupts(&driver, 1),
              tessera_start(&driver), tessera_status(&driver, &word), tessera_wait(&driver, 1),
              tessera_acknowledge(&driver, &word), tessera_ring_count(&driver, &word),
              tessera_ring_pop(&driver, &triangle), tessera_last_error(&driver, &address)}) {
            CHECK((result == TESSERA_OK || result == TESSERA_BUS || result == TESSERA_TIMEOUT));
            errors += result == TESSERA_BUS ? 1u : 0u;
        }
        CHECK(errors == (failing < device.accesses ? 1u : 0u));
        return device.accesses;
    };
    const unsigned all = use(~0u);
    CHECK(all > 25);
    for (unsigned failing = 0; failing < all; ++failing)
        use(failing);
}

TEST_CASE("driver: a write that is refused is a bus error if the status cannot be read either") {
    Words device;
    tessera_driver driver = device.driver();
    device.words[offset::status / 4] = TESSERA_STATUS_BUSY;
    device.failing = device.accesses + 1;  // the write
    CHECK(tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH, 1) == TESSERA_BUSY);
    device.failing = device.accesses + 1;
    device.failures = 2;
    CHECK(tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH, 1) == TESSERA_BUS);
}

TEST_CASE("driver: a platform without a pause polls without one") {
    Words device;
    tessera_platform platform = device.platform();
    platform.pause = nullptr;
    tessera_driver driver;
    REQUIRE(tessera_init(&driver, &platform) == TESSERA_OK);
    device.words[offset::status / 4] = TESSERA_STATUS_BUSY;
    CHECK(tessera_wait(&driver, 3) == TESSERA_TIMEOUT);
    CHECK(device.pauses == 0);
}

TEST_CASE("driver: the example ends at the first error") {
    Words device;
    const tessera_platform platform = device.platform();
    const example_scene scene{};
    device.words[offset::status / 4] = TESSERA_STATUS_ERROR;
    device.words[offset::error / 4] = TESSERA_ERROR_BAD_RING_SIZE;
    CHECK(draw_three_frames(&platform, &scene) == TESSERA_ERROR_BAD_RING_SIZE);
    device.words[0] = 0;
    CHECK(draw_three_frames(&platform, &scene) == TESSERA_NO_DEVICE);
}

TEST_CASE("driver: every result has a text") {
    std::set<std::string> texts;
    for (int result = TESSERA_BAD_VALUE; result < TESSERA_ERRORS; ++result)
        CHECK(texts.insert(tessera_text(result)).second);
    CHECK(std::string(tessera_text(TESSERA_ERRORS)) == "unknown error");
    CHECK(std::string(tessera_text(-100)) == "unknown error");
    CHECK(std::string(tessera_text(TESSERA_ERROR_NONE)) == "no error");
}
