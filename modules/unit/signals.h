#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <systemc>
#include <unordered_map>
#include <vector>

#include "modules/stream/items.h"
#include "modules/unit/signal_sink.h"

namespace tessera {

/// Numbers of units in waveforms, the same in every design, so that waveforms/units.txt can name them.
class UnitNumbers {
  public:
    struct Entry {
        unsigned number;
        const char* name;  ///< SystemC name without the top module's
    };
    static const std::vector<Entry>& all();
    static constexpr unsigned bits = 6;
    static constexpr unsigned nobody = 0;
    static constexpr unsigned other = 63;  ///< not in all()

    /// By its name, which is looked at once per object.
    unsigned of(const sc_core::sc_object* object);

  private:
    std::unordered_map<const sc_core::sc_object*, unsigned> known_;
};

/// One unit's signals in a waveform file. Unit::show is called once to declare them, then at the end of each traced
/// cycle in which the unit was called, to show their values. So trace makes the same calls, in the same order, each
/// time: what depends on the unit's state is a value or a group, never an `if` around a call.
///
/// Signals stand in the unit's own scope unless a scope within it is given.
class Signals {
  public:
    Signals(SignalSink& sink, UnitNumbers& numbers, std::string scope)
        : sink_(sink), numbers_(numbers), scope_(std::move(scope)) {}

    /// Begins a call of Unit::show.
    void begin(bool declaring) {
        declaring_ = declaring;
        signal_ = memory_ = group_ = 0;
    }
    /// False: what is shown is how the cycles before the traced ones left it, and nothing pulses.
    void set_running() { running_ = true; }
    bool running() const { return running_; }

    void value(const char* name, unsigned bits, std::uint64_t value);
    void flag(const char* name, bool value) { this->value(name, 1, value ? 1 : 0); }
    /// One cycle long when `count` has changed since the last call.
    void pulse(const char* name, std::uint64_t count) { pulse_if(name, changed(count) && running_); }

    /// Whether `value` differs from what it was at the last call, 0 before the first: that something new has come.
    bool changed(std::uint64_t value);

    /// `show` shows signals that hold their values unless `known`. It is called to declare them as well.
    template <class Show>
    void group(bool known, Show&& show) {
        if (declaring_) {
            const std::size_t before = handles_.size();
            show();
            group_sizes_.push_back(handles_.size() - before);
        } else if (known) {
            ++group_;
            show();
        } else {
            signal_ += group_sizes_[group_++];
        }
    }

    /// A stream's input: valid, something is offered; ready, something is taken; stalled, something stands at the door
    /// when the cycle ends; waiting, items in the buffer. Several transfers in one cycle show as one.
    template <class Input>
    void input(const Input& input, const char* scope = nullptr) {
        inner_scope_ = scope;
        const bool taken = changed(input.taken()) && running_;
        const bool held = input.holds_back();
        pulse_or_level("valid", taken, held);
        pulse_if("ready", taken);
        flag("stalled", held);
        value("waiting", 16, input.size());
        inner_scope_ = nullptr;
    }

    /// A number for another unit, by name in waveforms/units.txt.
    void unit(const char* name, const sc_core::sc_object* object);

    /// Widths are those of the largest configuration, so that a save file fits all.
    void position(const char* name, const datapath::Position& p) { fields().position(name, p, ""); }
    void direction(const char* name, const datapath::Direction& n) { fields().direction(name, n, ""); }
    void screen(const char* name, const datapath::ScreenPosition& s) { fields().screen(name, s, ""); }

    /// An item's fields and annotations, in a scope of their own; null: in the unit's.
    template <class Item>
    void item(const char* scope, const Item& item) {
        inner_scope_ = scope;
        describe_item(*this, item, formats, 32);
        inner_scope_ = nullptr;
    }

    /// For the description of an item's fields (modules/datapath/fields.h).
    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        if (declaring_)
            declare(name_of(field).c_str(), static_cast<unsigned>(field.most_bits));
        else
            set(static_cast<std::uint64_t>(value));
        return value;
    }
    std::uint32_t annotation(const char* name, std::uint32_t value) {
        this->value(name, 32, value);
        return value;
    }

  private:
    void pulse_if(const char* name, bool now);
    void pulse_or_level(const char* name, bool pulse, bool level);
    void declare(const char* name, unsigned bits);
    void set(std::uint64_t value);
    static std::string name_of(const datapath::Field& field);
    datapath::Fields<Signals> fields() { return {*this, formats}; }

    static constexpr datapath::Formats formats{};  // whose widths are not looked at

    SignalSink& sink_;
    UnitNumbers& numbers_;
    std::string scope_;
    const char* inner_scope_ = nullptr;
    bool declaring_ = true;
    bool running_ = false;
    std::vector<SignalSink::Signal> handles_;
    std::vector<std::uint64_t> remembered_;
    std::vector<std::size_t> group_sizes_;
    std::size_t signal_ = 0;
    std::size_t memory_ = 0;
    std::size_t group_ = 0;
};

}  // namespace tessera
