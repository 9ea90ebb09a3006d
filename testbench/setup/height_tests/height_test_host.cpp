#include "testbench/setup/height_tests/height_test_host.h"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "modules/datapath/height_tests.h"

namespace tessera {

namespace {

std::vector<const HeightTestHost*>& list() {
    static std::vector<const HeightTestHost*> all{&summed_height_host(), &rank_host(), &curvature_host(),
                                                  &mipmap_host()};
    return all;
}

}  // namespace

const std::vector<const HeightTestHost*>& height_test_hosts() {
    return list();
}

void add_height_test_host(const HeightTestHost& host) {
    if (list().size() + 1 != datapath::height_tests().size())
        throw std::invalid_argument("the host's part belongs to the height test that was added last");
    list().push_back(&host);
}

std::string meaning_of_height_tests() {
    std::string text;
    for (std::size_t k = 0; k < list().size(); ++k)
        text += std::string(k == 0   ? ""
                            : k == 1 ? ". In its place: "
                                     : "; ") +
                datapath::height_tests()[k]->name + ": " + list()[k]->meaning();
    return text;
}

std::vector<std::string_view> searched_height_tests() {
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < list().size(); ++k)
        if (list()[k]->searched() != nullptr)
            names.emplace_back(datapath::height_tests()[k]->name);
    return names;
}

const HeightTestHost& host_of(datapath::HeightTest test) {
    return *height_test_hosts().at(static_cast<std::size_t>(test));
}

}  // namespace tessera
