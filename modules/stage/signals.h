#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <systemc>
#include <unordered_map>
#include <vector>

#include "modules/sockets/items.h"
#include "modules/stage/signal_sink.h"

namespace tessera {

/// The numbers by which waveforms show units.
class UnitNumbers {
  public:
    struct Entry {
        unsigned number;
        std::string name;  ///< SystemC name without that of the top module
        /// In waveforms/units.txt: without its Tessellation Tests unit's name; _1, _2, ... from the second on.
        std::string shown;
    };
    static constexpr unsigned bits = 7;
    static constexpr unsigned nobody = 0;
    static constexpr unsigned other = 127;  ///< not numbered

    /// `all` must outlive it.
    explicit UnitNumbers(const std::vector<Entry>& all) : all_(all) {}

    /// The number of a unit, by its name. The name is looked up once per object.
    unsigned of(const sc_core::sc_object* object);

  private:
    const std::vector<Entry>& all_;
    std::unordered_map<const sc_core::sc_object*, unsigned> known_;
};

/// One unit's signals in a waveform file. Unit::trace_signals is called once to declare them, then at the end of each
/// traced cycle in which the unit was called, to show their values. A signal is identified by name and scope, and keeps
/// its value if a call is omitted; an undeclared signal is an SC_ERROR.
///
/// Signals are in the unit's own scope unless a scope within it is given.
class Signals {
  public:
    Signals(SignalSink& sink, UnitNumbers& numbers, std::string scope)
        : sink_(sink), numbers_(numbers), scope_(std::move(scope)) {}

    /// Begins a call of Unit::trace_signals.
    void begin(bool declaring) {
        declaring_ = declaring;
        next_ = 0;
    }
    /// Until this is called, the state before the first traced cycle is shown, without pulses.
    void set_running() { running_ = true; }
    bool running() const { return running_; }

    void value(const char* name, unsigned bits, std::uint64_t value) {
        if (declaring_)
            declare({inner_scope_, name, "", -1}, bits);
        else
            sink_.set(find({inner_scope_, name, "", -1}).signal, value);
    }
    void flag(const char* name, bool value) { this->value(name, 1, value ? 1 : 0); }
    /// Pulses for one cycle if `count` has changed since the last call.
    void pulse(const char* name, std::uint64_t count) { pulse_or_level(name, changed(name, count), false); }

    /// Whether `value` differs from that of the last call with this name (0 before the first).
    bool changed(const char* name, std::uint64_t value);
    /// For signals that hold their values while `known` is false: whether to call them now. Always true when declaring.
    bool when(bool known) const { return declaring_ || known; }

    /// A stream's input. valid: an item is offered; ready: an item is accepted; stalled: an item still waits at the end
    /// of the cycle; waiting: items in the buffer. Several transfers in one cycle show as one.
    template <class Input>
    void input(const Input& input, const char* scope = "") {
        inner_scope_ = scope;
        const bool taken = changed("taken", input.taken());
        const bool held = input.holds_back();
        pulse_or_level("valid", taken, held);
        pulse_or_level("ready", taken, false);
        flag("stalled", held);
        value("waiting", 16, input.size());
        inner_scope_ = "";
    }

    /// Another unit, shown as its number in waveforms/units.txt.
    void unit(const char* name, const sc_core::sc_object* object);

    /// Widths are those of the largest configuration, so that one save file fits all.
    void direction(const char* name, const datapath::Direction& n) { fields().direction(name, n, ""); }
    void screen(const char* name, const datapath::ScreenPosition& s) { fields().screen(name, s, ""); }

    /// An item's fields and annotations, in a scope of their own.
    template <class Item>
    void item(const char* scope, const Item& item) {
        inner_scope_ = scope;
        describe_item(*this, item, formats, 32);
        inner_scope_ = "";
    }

    /// For the description of an item's fields (modules/datapath/fields.h).
    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        const Name name{inner_scope_, field.name, field.component, field.index};
        if (declaring_)
            declare(name, static_cast<unsigned>(field.most_bits));
        else
            sink_.set(find(name).signal, static_cast<std::uint64_t>(value));
        return value;
    }
    std::uint32_t annotation(const char* name, std::uint32_t value) {
        this->value(name, 32, value);
        return value;
    }

  private:
    struct Name {
        const char* scope;  // within the unit's; or ""
        const char* name;
        const char* component;  // of a vector; or ""
        int index;              // of three alike; or -1

        bool operator==(const Name& other) const;
    };
    struct Declared {
        Name name;
        SignalSink::Signal signal = 0;
        std::uint64_t remembered = 0;
    };

    void pulse_or_level(const char* name, bool pulse, bool level);
    void declare(const Name& name, unsigned bits);
    Declared& find(const Name& name);
    datapath::Fields<Signals> fields() { return {*this, formats}; }

    static constexpr datapath::Formats formats{};  // its widths are not used

    SignalSink& sink_;
    UnitNumbers& numbers_;
    std::string scope_;
    const char* inner_scope_ = "";
    bool declaring_ = true;
    bool running_ = false;
    std::vector<Declared> declared_;
    std::size_t next_ = 0;  // where the search in declared_ begins: calls are mostly in the order of declaration
};

}  // namespace tessera
