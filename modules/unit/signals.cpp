#include "modules/unit/signals.h"

#include <algorithm>
#include <utility>

namespace tessera {

const std::vector<UnitNumbers::Entry>& UnitNumbers::all() {
    // In the order of the figures. Of three Tessellation Tests units the second and third come last.
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

void Signals::value(const char* name, unsigned bits, std::uint64_t value) {
    if (declaring_)
        declare(name, bits);
    else
        set(value);
}

bool Signals::changed(std::uint64_t value) {
    if (declaring_) {
        remembered_.push_back(0);
        return false;
    }
    return std::exchange(remembered_[memory_++], value) != value;
}

void Signals::unit(const char* name, const sc_core::sc_object* object) {
    group(changed(reinterpret_cast<std::uintptr_t>(object)),
          [&] { value(name, UnitNumbers::bits, declaring_ ? 0 : numbers_.of(object)); });
}

void Signals::set(std::uint64_t value) {
    sink_.set(handles_[signal_++], value);
}

std::string Signals::name_of(const datapath::Field& field) {
    std::string name = field.name;
    if (field.index >= 0)
        name += "_" + std::to_string(field.index);
    if (field.component[0] != '\0')
        name += std::string("_") + field.component;
    return name;
}

void Signals::pulse_if(const char* name, bool now) {
    if (declaring_)
        declare(name, 1);
    else if (now)
        sink_.pulse(handles_[signal_++]);
    else
        sink_.set(handles_[signal_++], 0);
}

void Signals::pulse_or_level(const char* name, bool pulse, bool level) {
    if (declaring_)
        declare(name, 1);
    else if (pulse && !level)
        sink_.pulse(handles_[signal_++]);
    else
        sink_.set(handles_[signal_++], level ? 1 : 0);
}

void Signals::declare(const char* name, unsigned bits) {
    const std::string scope = inner_scope_ == nullptr ? scope_ : scope_ + "." + inner_scope_;
    handles_.push_back(sink_.add(scope, name, bits));
}

}  // namespace tessera
