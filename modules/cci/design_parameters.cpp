#include "modules/cci/design_parameters.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "modules/timing/timing_keys.h"

namespace tessera {

namespace {

bool in_hierarchy() {
    return sc_core::sc_get_current_object() != nullptr;
}

std::string absolute(const std::string& prefix) {
    return (in_hierarchy() ? sc_core::sc_get_current_object()->name() + ('.' + prefix) : prefix) + '.';
}

void refuse(const std::string& name, const cci::cci_value& preset, const std::string& reason) {
    SC_REPORT_ERROR("tessera/cci", (name + " = " + preset.to_json() + ' ' + reason).c_str());
}

/// The number of letters that two names have in common at their beginnings and ends.
std::ptrdiff_t letters_in_common(const std::string& a, const std::string& b) {
    return std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin() +
           (std::mismatch(a.rbegin(), a.rend(), b.rbegin(), b.rend()).first - a.rbegin());
}

/// Declares the keys of the table [hardware] of a job file (testbench/job).
template <typename Keys>
void declare_hardware(const Keys& key) {
    constexpr unsigned any_count = 2147483647;
    key.template add_choice<TriangleOrder>(
        "queue_order", [](auto& d) -> auto& { return d.queue.order; },
        "Triangle Queue: first in first out, or last in first out");
    key.add_number(
        "queue_watermark", [](auto& d) -> auto& { return d.queue.watermark; }, "triangles", {1, any_count},
        "Get Triangle accepts triangles from the host while fewer than this many wait in the queue");
    key.add_number(
        "queue_capacity", [](auto& d) -> auto& { return d.queue.capacity; }, "triangles", {0, any_count},
        "Timed mode: on-chip capacity of the Triangle Queue; 0: unbounded");
    key.add_number(
        "off_chip_triangles", [](auto& d) -> auto& { return d.queue.off_chip_triangles; }, "triangles", {1, 1000000000},
        "Timed mode: capacity of off-chip memory for spilled triangles");
    key.template add_choice<QueueOverflow>(
        "queue_overflow", [](auto& d) -> auto& { return d.queue.overflow; },
        "Timed mode: a full queue spills to off-chip memory, stalls the pipeline, or halts the clock");
    key.add_number(
        "tests_units", [](auto& d) -> auto& { return d.tests_units; }, "-", {1, 3},
        "Timed mode: Tessellation Tests units, 1 or 3 (one for each edge of a triangle)");
    key.template add_choice<Work>(
        "work", [](auto& d) -> auto& { return d.work; },
        "Contents of the Triangle Queue. triangle: every child (the paper's); family: only "
        "triangles that are known to split, whose children are then tested together");
    key.template add_choice<TestOrder>(
        "test_order", [](auto& d) -> auto& { return d.test_order; },
        "parallel: all tests of an edge at once (the paper's); cheap_first: first the tests that "
        "read no table, the others only if the decision still depends on them");
    key.add_number(
        "edge_lanes", [](auto& d) -> auto& { return d.edge_lanes; }, "-", {1, 9},
        "Timed mode, with work = family and test_order = cheap_first: lanes of the cheap tests");
    key.add_number(
        "normal_tests", [](auto& d) -> auto& { return d.normal_tests; }, "-", {1, 9},
        "Timed mode, likewise: Normal Tests, shared by the lanes");
    key.add_number(
        "transform_pipelines", [](auto& d) -> auto& { return d.transform_pipelines; }, "-", {1, 16},
        "Timed mode: Transform pipelines, used in turn");
}

}  // namespace

/// Declares parameters of members of `group`, and gives the members their values.
template <typename Group>
class DesignParameters::Keys {
  public:
    /// table: the name of a job file's table with a dot, or empty.
    Keys(DesignParameters& parameters, Group& group, const std::string& table)
        : to_(parameters), group_(group), prefix_(parameters.prefix_ + table) {}

    template <typename Member>
    void add_number(const std::string& leaf, Member member, const std::string& unit, TimingRange range,
                    const std::string& description) const {
        const std::string allowed = "an integer, " + std::to_string(range.least) + " .. " + std::to_string(range.most) +
                                    (unit == "-" ? "" : ' ' + unit);
        auto& figure = member(group_);
        figure = static_cast<std::remove_reference_t<decltype(figure)>>(
            add<sc_dt::uint64>(leaf, figure, unit, description, allowed, [range](const cci::cci_value& preset) {
                return preset.is_uint64() && preset.get_uint64() >= range.least && preset.get_uint64() <= range.most;
            }));
    }

    template <typename Enum, typename Member>
    void add_choice(const std::string& leaf, Member member, const std::string& description) const {
        std::vector<std::string> names;
        std::string allowed;
        for (int k = 0; !name_of(static_cast<Enum>(k)).empty(); ++k) {
            names.emplace_back(name_of(static_cast<Enum>(k)));
            allowed += (k == 0 ? "one of " : ", ") + names.back();
        }
        const auto place = [&names](const std::string& name) { return std::find(names.begin(), names.end(), name); };
        Enum& choice = member(group_);
        const std::string name = add<std::string>(
            leaf, std::string(name_of(choice)), "-", description, allowed, [&](const cci::cci_value& preset) {
                return preset.is_string() && place(preset.get<std::string>()) != names.end();
            });
        choice = static_cast<Enum>(place(name) - names.begin());
    }

  private:
    /// Its value.
    template <typename Value, typename Check>
    Value add(const std::string& leaf, const Value& standard, const std::string& unit, const std::string& description,
              const std::string& allowed, Check may_be) const {
        const std::string name = prefix_ + leaf;
        if (to_.broker_.has_preset_value(name)) {
            const cci::cci_value preset = to_.broker_.get_preset_cci_value(name);
            if (!may_be(preset))
                refuse(name, preset, "is invalid: must be " + allowed);
        }
        auto parameter = std::make_unique<cci::cci_param<Value, cci::CCI_IMMUTABLE_PARAM>>(
            name, standard, to_.broker_, description, cci::CCI_ABSOLUTE_NAME, to_.originator_);
        parameter->add_metadata("unit", cci::cci_value(unit));
        Value value = parameter->get_value();
        to_.parameters_.push_back(std::move(parameter));
        return value;
    }

    DesignParameters& to_;
    Group& group_;
    std::string prefix_;
};

DesignParameters::DesignParameters(const std::string& prefix, const Design& defaults)
    : prefix_(absolute(prefix)),
      originator_(in_hierarchy() ? cci::cci_originator() : cci::cci_originator(prefix)),
      broker_(in_hierarchy() ? cci::cci_get_broker() : cci::cci_get_global_broker(originator_)),
      design_(defaults) {
    declare_timing_keys(Keys<Timing>(*this, design_.timing, "timing."));
    Keys<Design>(*this, design_, "")
        .add_choice<Transport>(
            "mode", [](auto& d) -> auto& { return d.transport; },
            "functional: all results except cycle counts, fastest; timed: cycle-accurate");
    declare_hardware(Keys<Design>(*this, design_, "hardware."));
    if (design_.tests_units == 2)
        refuse(prefix_ + "hardware.tests_units", cci::cci_value(2), "is invalid: must be 1 or 3");
    for (const auto& [name, preset] : broker_.get_unconsumed_preset_values()) {
        if (name.compare(0, prefix_.size(), prefix_) != 0)
            continue;
        const auto nearest =
            std::max_element(parameters_.begin(), parameters_.end(), [&mistyped = name](const auto& a, const auto& b) {
                return letters_in_common(mistyped, a->name()) < letters_in_common(mistyped, b->name());
            });
        refuse(name, preset,
               std::string("is preset, but no such parameter exists; did you mean ") + (*nearest)->name() + '?');
    }
}

}  // namespace tessera
