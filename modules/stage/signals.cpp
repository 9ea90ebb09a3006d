#include "modules/stage/signals.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tessera {

unsigned UnitNumbers::of(const sc_core::sc_object* object) {
    if (object == nullptr)
        return nobody;
    const auto known = known_.find(object);
    if (known != known_.end())
        return known->second;
    const std::string_view name = object->name();
    const auto is_it = [&](const Entry& entry) {
        const std::string& its = entry.name;
        return name == its ||
               (name.size() > its.size() && name.substr(name.size() - its.size()) == its &&
                name[name.size() - its.size() - 1] == '.' && name.find('.') == name.size() - its.size() - 1);
    };
    const auto found = std::find_if(all_.begin(), all_.end(), is_it);
    const unsigned number = found == all_.end() ? other : found->number;
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
