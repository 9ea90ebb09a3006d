#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

namespace tessera {

/// Limits the simulated time for which a module outside the machine may leave a request unanswered. SC_ERROR beyond it:
/// who waits, for which address, since when. A module that does not let simulated time pass cannot be noticed.
class AnswerWatch : public sc_core::sc_module {
  public:
    /// who: the socket that waits. limit: zero for none. more: what else is known; may be empty.
    AnswerWatch(const sc_core::sc_module_name& name, std::string who, const sc_core::sc_time& limit,
                std::function<std::string()> more = {});

    /// A request begins, and may be answered after `ahead` (its initiator's local time) and the limit. Returns what
    /// end() takes.
    std::uint64_t begin(tlm::tlm_command command, std::uint64_t address, const sc_core::sc_time& ahead);
    void end(std::uint64_t request);
    /// Call when nothing is under way: keeps the kernel no longer awake.
    void rest();

  private:
    struct Waiting {
        std::uint64_t request;
        tlm::tlm_command command;
        std::uint64_t address;
        sc_core::sc_time since, until;
    };
    void look();
    void report(const Waiting& waiting) const;

    std::string who_;
    sc_core::sc_time limit_;
    std::function<std::string()> more_;
    std::vector<Waiting> waiting_;  // the oldest first
    std::uint64_t next_ = 0;
    bool armed_ = false;
    sc_core::sc_event look_;
};

}  // namespace tessera
