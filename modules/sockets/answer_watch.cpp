#include "modules/sockets/answer_watch.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace tessera {

AnswerWatch::AnswerWatch(const sc_core::sc_module_name& name, std::string who, const sc_core::sc_time& limit,
                         std::function<std::string()> more)
    : sc_module(name), who_(std::move(who)), limit_(limit), more_(std::move(more)), look_("time_to_look") {
    SC_HAS_PROCESS(AnswerWatch);
    SC_METHOD(look);
    dont_initialize();
    sensitive << look_;
}

std::uint64_t AnswerWatch::begin(tlm::tlm_command command, std::uint64_t address, const sc_core::sc_time& ahead) {
    if (limit_ == sc_core::SC_ZERO_TIME)
        return next_;
    const sc_core::sc_time& now = sc_core::sc_time_stamp();
    waiting_.push_back({next_, command, address, now, now + ahead + limit_});
    // The event is not moved for each request, since a cancelled notification stays in the kernel until its time.
    if (!std::exchange(armed_, true))
        look_.notify(ahead + limit_);
    return next_++;
}

void AnswerWatch::end(std::uint64_t request) {
    const auto ended =
        std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) { return one.request == request; });
    if (ended != waiting_.end())
        waiting_.erase(ended);
}

void AnswerWatch::rest() {
    if (waiting_.empty() && std::exchange(armed_, false))
        look_.cancel();
}

void AnswerWatch::look() {
    armed_ = false;
    if (waiting_.empty())
        return;
    const sc_core::sc_time& now = sc_core::sc_time_stamp();
    const auto first = std::min_element(waiting_.begin(), waiting_.end(),
                                        [](const Waiting& a, const Waiting& b) { return a.until < b.until; });
    if (first->until > now) {
        armed_ = true;
        look_.notify(first->until - now);
        return;
    }
    const Waiting late = *first;
    waiting_.clear();
    report(late);
}

void AnswerWatch::report(const Waiting& waiting) const {
    std::ostringstream message;
    message << who_ << ": the " << (waiting.command == tlm::TLM_WRITE_COMMAND ? "write to" : "read of") << " address 0x"
            << std::hex << waiting.address << " has waited since " << waiting.since << ", now "
            << sc_core::sc_time_stamp() << ", without an answer" << (more_ ? more_() : std::string{})
            << "; the limit is " << limit_
            << ": if what is behind the socket is only slow, raise Design::answer_cycles (0: no limit)";
    SC_REPORT_ERROR("tessera/memory", message.str().c_str());
}

}  // namespace tessera
