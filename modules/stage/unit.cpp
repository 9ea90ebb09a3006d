#include "modules/stage/unit.h"

#include "modules/stage/signals.h"

namespace tessera {

void Unit::trace_signals(Signals& signals) const {
    signals.value("state", 2, static_cast<std::uint64_t>(activity_.state()));
    signals.unit("blocked_by", activity_.by());
    signals.value("occupancy", 32, activity_.level());
}

std::string count_of(std::size_t count, const char* what) {
    if (count == 0)
        return {};
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string listed(const std::string& text, const std::string& more, const char* separator) {
    return text.empty() || more.empty() ? text + more : text + separator + more;
}

}  // namespace tessera
