#include "modules/stage/signals.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tessera {

const std::vector<UnitNumbers::Entry>& UnitNumbers::all() {
    // In the order of the figures; then the second and third of three Tessellation Tests units, what other designs
    // have, and the first further lanes and Normal Tests.
    static const std::vector<Entry> entries = {
        {1, "get_triangle"},
        {2, "calculate_new_p"},
        {3, "displace_vertex"},
        {4, "transform"},
        {5, "tessellation_tests_0.calculate_new_u"},
        {6, "tessellation_tests_0.tex_coord_test"},
        {7, "tessellation_tests_0.summed_height_test"},
        {8, "tessellation_tests_0.normal_test"},
        {9, "tessellation_tests_0.view_test"},
        {10, "tessellation_tests_0.collect_tests"},
        {11, "pass_or_tessellate"},
        {12, "tessellation"},
        {13, "triangle_queue"},
        {14, "lighting"},
        {15, "displacement_map"},
        {16, "normal_map"},
        {17, "summed_height_table"},
        {18, "off_chip_memory"},
        {19, "rasteriser"},
        {20, "host"},
        {21, "tessellation_tests_1.calculate_new_u"},
        {22, "tessellation_tests_1.tex_coord_test"},
        {23, "tessellation_tests_1.summed_height_test"},
        {24, "tessellation_tests_1.normal_test"},
        {25, "tessellation_tests_1.view_test"},
        {26, "tessellation_tests_1.collect_tests"},
        {27, "tessellation_tests_2.calculate_new_u"},
        {28, "tessellation_tests_2.tex_coord_test"},
        {29, "tessellation_tests_2.summed_height_test"},
        {30, "tessellation_tests_2.normal_test"},
        {31, "tessellation_tests_2.view_test"},
        {32, "tessellation_tests_2.collect_tests"},
        {33, "tessellation_tests_0.sequence_tests"},
        {34, "tessellation_tests_1.sequence_tests"},
        {35, "tessellation_tests_2.sequence_tests"},
        {36, "displacement_map_cache"},
        {37, "normal_map_cache"},
        {38, "summed_height_table_cache"},
        {39, "tessellation_tests_0.calculate_new_u_1"},
        {40, "tessellation_tests_0.tex_coord_test_1"},
        {41, "tessellation_tests_0.normal_test_1"},
        {42, "tessellation_tests_0.view_test_1"},
        {43, "tessellation_tests_0.calculate_new_u_2"},
        {44, "tessellation_tests_0.tex_coord_test_2"},
        {45, "tessellation_tests_0.normal_test_2"},
        {46, "tessellation_tests_0.view_test_2"},
        {47, "tessellation_tests_0.calculate_new_u_3"},
        {48, "tessellation_tests_0.tex_coord_test_3"},
        {49, "tessellation_tests_0.normal_test_3"},
        {50, "tessellation_tests_0.view_test_3"},
        {51, "tessellation_tests_0.rank_test"},
        {52, "tessellation_tests_1.rank_test"},
        {53, "tessellation_tests_2.rank_test"},
        {54, "rank_table"},
        {55, "rank_table_cache"},
        {56, "tessellation_tests_0.curvature_test"},
        {57, "tessellation_tests_1.curvature_test"},
        {58, "tessellation_tests_2.curvature_test"},
        {59, "curvature_table"},
        {60, "curvature_table_cache"},
        {61, "tessellation_tests_0.mipmap_test"},
        {62, "tessellation_tests_1.mipmap_test"},
        {63, "tessellation_tests_2.mipmap_test"},
        {64, "mipmap_table"},
        {65, "mipmap_table_cache"},
        {66, "displacement_map_for_tests"},
    };
    return entries;
}

unsigned UnitNumbers::of(const sc_core::sc_object* object) {
    if (object == nullptr)
        return nobody;
    const auto known = known_.find(object);
    if (known != known_.end())
        return known->second;
    const std::string_view name = object->name();
    const auto is_it = [&](const Entry& entry) {
        const std::string_view its = entry.name;
        return name == its ||
               (name.size() > its.size() && name.substr(name.size() - its.size()) == its &&
                name[name.size() - its.size() - 1] == '.' && name.find('.') == name.size() - its.size() - 1);
    };
    const auto found = std::find_if(all().begin(), all().end(), is_it);
    const unsigned number = found == all().end() ? other : found->number;
    known_.emplace(object, number);
    return number;
}

bool Signals::Name::operator==(const Name& other) const {
    const auto same = [](const char* a, const char* b) { return a == b || std::strcmp(a, b) == 0; };
    return index == other.index && same(name, other.name) && same(component, other.component) &&
           same(scope, other.scope);
}

void Signals::declare(const Name& name, unsigned bits) {
    const std::string scope = name.scope[0] == '\0' ? scope_ : scope_ + "." + name.scope;
    std::string text = name.name;
    if (name.index >= 0)
        text += "_" + std::to_string(name.index);
    if (name.component[0] != '\0')
        text += std::string("_") + name.component;
    declared_.push_back({name, sink_.add(scope, text, bits)});
}

Signals::Declared& Signals::find(const Name& name) {
    for (std::size_t tries = 0; tries < declared_.size(); ++tries) {
        Declared& declared = declared_[next_];
        next_ = next_ + 1 == declared_.size() ? 0 : next_ + 1;
        if (declared.name == name)
            return declared;
    }
    const std::string message = scope_ + ": traces " + name.name + ", which is not declared";
    SC_REPORT_ERROR("tessera/trace", message.c_str());
    throw std::logic_error(message);  // where SC_ERROR is configured not to throw
}

bool Signals::changed(const char* name, std::uint64_t value) {
    const Name counter{inner_scope_, name, "count", -1};
    if (declaring_) {
        declared_.push_back({counter});
        return false;
    }
    return std::exchange(find(counter).remembered, value) != value;
}

void Signals::unit(const char* name, const sc_core::sc_object* object) {
    if (when(changed(name, reinterpret_cast<std::uintptr_t>(object))))
        value(name, UnitNumbers::bits, declaring_ ? 0 : numbers_.of(object));
}

/// There is no pulse before the traced cycles.
void Signals::pulse_or_level(const char* name, bool pulse, bool level) {
    const Name signal{inner_scope_, name, "", -1};
    if (declaring_)
        declare(signal, 1);
    else if (pulse && running_ && !level)
        sink_.pulse(find(signal).signal);
    else
        sink_.set(find(signal).signal, level ? 1 : 0);
}

}  // namespace tessera
