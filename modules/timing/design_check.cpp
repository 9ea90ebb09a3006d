#include "modules/timing/design_check.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "modules/timing/design_keys.h"
#include "modules/timing/design_rules.h"

namespace tessera {

namespace {

/// A declared member.
struct Number {
    std::string member, unit, meaning;
    std::uint64_t value, least, most;
};

/// Lists the declared members of `Group`, but for switches.
template <typename Group>
class NumberList {
  public:
    NumberList(const Group& group, const char* prefix, std::vector<Number>& numbers)
        : group_(group), prefix_(prefix), numbers_(numbers) {}

    template <typename Member>
    void add_number(const DesignName& name, Member member, const char* unit, DesignRange range,
                    const std::string& meaning) const {
        numbers_.push_back({prefix_ + name.member, unit, meaning, member(group_), range.least, range.most});
    }
    template <typename Enum, typename Member>
    void add_choice(const DesignName& name, Member member, const std::string& meaning) const {
        std::uint64_t count = 0;
        while (!name_of(static_cast<Enum>(count)).empty())
            ++count;
        numbers_.push_back(
            {prefix_ + name.member, "-", meaning, static_cast<std::uint64_t>(member(group_)), 0, count - 1});
    }
    template <typename Member>
    void add_switch(const DesignName&, Member, const char*) const {}

  private:
    const Group& group_;
    const std::string prefix_;
    std::vector<Number>& numbers_;
};

std::vector<Number> numbers_of(const Design& design) {
    std::vector<Number> numbers;
    declare_option_keys(NumberList<DesignOptions>(design, "", numbers));
    declare_timing_keys(NumberList<Timing>(design.timing, "timing.", numbers));
    return numbers;
}

void check_format(const char* member, int value, datapath::FormatLimits::Range range, std::string& faults) {
    if (value < range.least || value > range.most)
        faults += std::string("Formats::") + member + " = " + std::to_string(value) + ": must be " +
                  std::to_string(range.least) + " to " + std::to_string(range.most) + " bits\n";
}

void check_formats(const Design& design, const datapath::Formats& f, std::string& faults) {
    using Limits = datapath::FormatLimits;
    check_format("position.bits", f.position.bits, Limits::position_bits, faults);
    check_format("position.fraction", f.position.fraction, {0, f.position.bits - 1}, faults);
    check_format("normal.bits", f.normal.bits, Limits::normal_bits, faults);
    // With one integer bit, which a job refuses, normals of 1.0 saturate, and are counted.
    check_format("normal.fraction", f.normal.fraction, {0, f.normal.bits - 1}, faults);
    check_format("texture.fraction", f.texture.fraction, Limits::texture_fraction, faults);
    const int no_integer = 1 + f.texture.fraction;
    check_format("texture.bits", f.texture.bits,
                 {no_integer + Limits::texture_integer.least, no_integer + Limits::texture_integer.most}, faults);
    check_format("tex_coord_fraction", f.tex_coord_fraction, {0, f.texture.fraction}, faults);
    check_format("displacement.bits", f.displacement.bits, Limits::displacement_bits, faults);
    check_format("summed_height.bits", f.summed_height.bits, Limits::summed_height_bits, faults);
    check_format("screen.bits", f.screen.bits, Limits::screen_bits, faults);
    check_format("screen.fraction", f.screen.fraction, {0, f.screen.bits - 1}, faults);
    check_format("generation_bits", f.generation_bits, Limits::generation_bits, faults);
    if (f.rank_bits != 0)
        check_format("rank_bits", f.rank_bits, Limits::rank_bits, faults);
    if (f.bound_bits != 0 || f.rank_bits == 0)
        check_format("bound_bits", f.bound_bits, Limits::bound_bits, faults);
    if ((design.work == Work::family) != f.families)
        faults += "Design::work and Formats::families disagree: set both, or neither\n";
    if (f.distances && design.test_order != TestOrder::cheap_first)
        faults +=
            "Formats::distances = true, which the View Test computes before the Rank Test: must be with "
            "Design::test_order = TestOrder::cheap_first\n";
}

}  // namespace

std::string design_faults(const Design& design, const datapath::Formats& formats) {
    const std::vector<Number> numbers = numbers_of(design);
    std::string faults;
    for (const Number& it : numbers)
        if (it.value < it.least || it.value > it.most)
            faults += "Design::" + it.member + " = " + std::to_string(it.value) + ": must be " +
                      std::to_string(it.least) + " to " + std::to_string(it.most) +
                      (it.unit == "-" ? "" : ' ' + it.unit) + " (" + it.meaning + ")\n";
    if (design.transport != Transport::blocking && design.transport != Transport::non_blocking)
        faults += "Design::transport = " + std::to_string(static_cast<int>(design.transport)) +
                  ": must be Transport::blocking or Transport::non_blocking\n";
    check_formats(design, formats, faults);
    if (!faults.empty())
        return faults;
    for (const DesignRule* const rule : broken_rules(design, design.timing)) {
        const auto broken = std::find_if(numbers.begin(), numbers.end(), [&](const Number& it) {
            return it.member == rule->member || it.member == std::string("timing.") + rule->member;
        });
        std::string settings;
        for (const DesignSetting& setting : rule->remedy(design, design.timing))
            settings += (settings.empty() ? "" : " and ") + setting.member + " = " + setting.value;
        faults += "Design::" + broken->member + " = " + std::to_string(broken->value) + ": " + rule->why + "; set " +
                  settings + '\n';
    }
    return faults;
}

}  // namespace tessera
