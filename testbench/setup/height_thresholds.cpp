#include "testbench/setup/height_thresholds.h"

#include <stdexcept>
#include <string>

#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

HeightThresholds::HeightThresholds() {
    for (const HeightTestHost* host : height_test_hosts())
        for (const HeightThresholdKey& key : host->thresholds())
            values_.push_back(key.value);
}

std::size_t HeightThresholds::index_of(std::string_view key) {
    std::size_t index = 0;
    for (const HeightTestHost* host : height_test_hosts())
        for (const HeightThresholdKey& declared : host->thresholds()) {
            if (declared.name == key)
                return index;
            ++index;
        }
    throw std::out_of_range("no height test has the threshold " + std::string(key));
}

}  // namespace tessera
