#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "modules/sockets/memory_port.h"
#include "modules/stage/fork.h"
#include "modules/stage/stage.h"
#include "modules/stage/stage_signals.h"
#include "modules/timing/elastic_pipeline.h"

namespace tessera {

// The implementation of stage.h. Include this file where a Stage is instantiated. What a stage shows of itself is in
// stage_signals.h.

/// The implementation of a stage.
template <class In, class Out>
struct Stage<In, Out>::Machinery {
    /// An item under way: the number of its requests and of those answered, and the port and number of entries of each.
    struct Slot {
        In item{};
        Out result{};
        std::uint8_t requests = 0;
        std::uint8_t answered = 0;
        std::array<std::uint8_t, Reads::most_requests> port;
        std::array<std::uint8_t, Reads::most_requests> count;
        std::uint64_t answered_at = 0;  // from a prompt memory: the cycle in which the entries have arrived

        bool processed() const { return answered == requests; }
    };

    Machinery(const UnitTiming& timing, unsigned pipelines, unsigned memory_latency)
        : servers(pipelines), pipeline(timing, pipelines, memory_latency) {}

    /// Reads the entries of the item that starts in `cycle` from a prompt memory: each request is offered when the one
    /// before it is accepted. Returns the cycle in which they have arrived.
    std::uint64_t read_promptly(std::uint64_t cycle) {
        std::uint64_t arrived = cycle;
        unsigned entry = 0;
        for (unsigned k = 0; k < reads.requests(); ++k) {
            const PromptMemory::Times times =
                ports[0]->read_promptly(reads.addresses() + entry, reads.count(k), &entries[entry], cycle);
            entry += reads.count(k);
            cycle = times.accepted;
            arrived = last_answer = times.answered;
        }
        asked = reads.requests();
        asked_at = cycle;
        return arrived;
    }

    /// Makes the requests of the item started last while the memories accept them. Returns true once all are accepted.
    bool ask(std::uint64_t cycle) {
        if (prompt)
            return asked_at <= cycle;
        for (; asked < reads.requests(); ++asked) {
            MemoryPort& port = *ports[reads.port(asked)];
            if (!port.may_request())
                return false;
            port.request(reads.addresses() + asked_entries, reads.count(asked));
            asked_entries += reads.count(asked);
        }
        return !ports[0]->on_offer() && (ports[1] == nullptr || !ports[1]->on_offer());
    }

    /// The port that receives the first item's next answer.
    const MemoryPort& awaited() const { return *ports[pipeline.front().port[pipeline.front().answered]]; }

    /// Skips the items whose answers have all arrived.
    void skip_processed() {
        while (waiting < pipeline.size() && pipeline.at(waiting).processed())
            ++waiting;
    }

    const unsigned servers;
    std::array<MemoryPort*, 2> ports{};  // null: the unit reads nothing
    Fork<Out> fork;
    ElasticPipeline<Slot> pipeline;
    Reads reads;                 // of the item started last
    unsigned asked = 0;          // number of these requests made
    unsigned asked_entries = 0;  // and of their entries
    Entries entries{};           // that have arrived for the first item that waits for entries
    unsigned come = 0;           // number of these entries
    std::size_t waiting = 0;     // the first item whose answers have not all arrived
    bool may_be_prompt = false;  // there is one port, to a prompt memory
    bool prompt = false;         // the items under way have read promptly
    std::uint64_t asked_at = 0;  // the cycle in which the last request of the item started last is accepted
    std::uint64_t last_answer = 0;
};

template <class In, class Out>
Stage<In, Out>::Stage(const sc_core::sc_module_name& name, const UnitContext& context, const UnitTiming& timing,
                      unsigned servers, unsigned memory_latency)
    : Unit(name, context.clock),
      timing_(timing),
      latency_(clock_.period() * timing.latency),
      machinery_(std::make_shared<Machinery>(timing, servers, memory_latency)) {
    const ItemWidths widths(context);
    area_.register_bits =
        timing.buffer * widths.of<In>() + machinery_->pipeline.capacity() * std::max(widths.of<In>(), widths.of<Out>());
}

template <class In, class Out>
bool Stage<In, Out>::reads_tables() const {
    return machinery_->ports[0] != nullptr;
}

template <class In, class Out>
void Stage<In, Out>::takes_from(const UnitContext& context, StreamInput<In>& input) {
    input_ = &input;
    input.template register_b_transport<&Stage::b_transport>(*this);
    input.clocked_by(clock_, *this, timing_.buffer, context.timing().stalls);
}

template <class In, class Out>
void Stage<In, Out>::delivers_to(const UnitContext& context, StreamOutput<Out>& output, Parts only) {
    machinery_->fork.add(output, only);
    output.clocked_by(context, *this);
}

template <class In, class Out>
template <class Payload>
void Stage<In, Out>::delivers_to(const UnitContext& context, StreamOutput<Payload>& output,
                                 Payload (*select)(const Out&), Parts only) {
    machinery_->fork.add(output, select, only);
    output.clocked_by(context, *this);
}

template <class In, class Out>
void Stage<In, Out>::reads_through(MemoryPort& port, unsigned most_requests) {
    machinery_->ports[reads_tables() ? 1 : 0] = &port;
    port.clocked_by(clock_, *this, machinery_->pipeline.capacity() * most_requests);
}

template <class In, class Out>
void Stage<In, Out>::multiplies(const datapath::Multiplications& multiplications) {
    area_.multiply(multiplications, timing_.interval, machinery_->servers);
}

template <class In, class Out>
void Stage<In, Out>::keeps(int bits) {
    area_.register_bits += machinery_->pipeline.capacity() * static_cast<std::uint64_t>(bits);
}

template <class In, class Out>
void Stage<In, Out>::b_transport(In& item, sc_core::sc_time& delay) {
    if (may_wait_) {
        if (!may_start(item))
            SC_REPORT_ERROR("tessera/stage",
                            (std::string(name()) + ": an item arrived before the data that it waits for").c_str());
        delay = std::max(delay, may_start_after(item));
    }
    Entries entries;
    if (reads_tables())
        read_entries(item, entries, delay);
    Out result = process(item, entries);
    delay += latency_;
    machinery_->fork.transport(result, delay);
}

template <class In, class Out>
void Stage<In, Out>::read_entries(const In& item, Entries& entries, sc_core::sc_time& delay) {
    Reads needed;
    reads(item, needed);
    unsigned entry = 0;
    for (unsigned request = 0; request < needed.requests(); ++request) {
        const unsigned count = needed.count(request);
        machinery_->ports[needed.port(request)]->read(needed.addresses() + entry, count, &entries[entry], delay);
        entry += count;
    }
}

template <class In, class Out>
template <TableReads Access>
void Stage<In, Out>::start(std::uint64_t cycle) {
    Machinery& m = *machinery_;
    typename Machinery::Slot& slot = m.pipeline.start(cycle);
    const In& item = input_->front();
    if (Access == TableReads::requested || clock_.observed())  // waveforms show it
        slot.item = item;
    activity_.item_in(cycle);
    if (Access != TableReads::none) {
        entries_arrive_ = cycle;
        m.reads.clear();
        reads(item, m.reads);
    }
    if (Access == TableReads::requested) {
        m.asked = m.asked_entries = 0;
        slot.answered = 0;
        slot.requests = static_cast<std::uint8_t>(m.reads.requests());
        // The first condition tells the compiler the bound that the second keeps.
        for (unsigned k = 0; k < Reads::most_requests && k < m.reads.requests(); ++k) {
            slot.port[k] = static_cast<std::uint8_t>(m.reads.port(k));
            slot.count[k] = static_cast<std::uint8_t>(m.reads.count(k));
        }
    }
    if (Access == TableReads::prompt) {
        slot.answered_at = entries_arrive_ = m.read_promptly(cycle);
        m.pipeline.finish(m.pipeline.size() - 1, slot.answered_at + m.pipeline.latency());
    }
    if (Access == TableReads::requested && slot.requests > 0)
        m.pipeline.finish(m.pipeline.size() - 1, never);
    else
        slot.result = process(item, m.entries);
    input_->pop();
}

/// Takes answers in the order of the items and of each item's requests, whichever port they use.
template <class In, class Out>
void Stage<In, Out>::take_answers(std::uint64_t cycle) {
    Machinery& m = *machinery_;
    for (m.skip_processed(); m.waiting < m.pipeline.size(); m.skip_processed()) {
        typename Machinery::Slot& slot = m.pipeline.at(m.waiting);
        MemoryPort& port = *m.ports[slot.port[slot.answered]];
        if (!port.answered())
            break;
        const unsigned count = slot.count[slot.answered++];
        port.copy_entries(0, count, &m.entries[m.come]);
        m.come += count;
        port.pop_answer();
        if (slot.processed()) {
            m.come = 0;
            entries_arrive_ = cycle;
            slot.result = process(slot.item, m.entries);
            m.pipeline.finish(m.waiting, cycle + m.pipeline.latency());
        }
    }
}

template <class In, class Out>
void Stage<In, Out>::start_of_simulation() {
    const auto& ports = machinery_->ports;
    machinery_->may_be_prompt =
        ports[0] != nullptr && ports[1] == nullptr && ports[0]->is_prompt() && (!may_wait_ || heeds_arrival_);
}

template <class In, class Out>
void Stage<In, Out>::step() {
    Machinery& m = *machinery_;
    if (m.may_be_prompt && m.pipeline.empty())
        m.prompt = !clock_.observed();  // waveforms show requests and answers
    if (!reads_tables())
        step_with<TableReads::none>();
    else if (m.prompt)
        step_with<TableReads::prompt>();
    else
        step_with<TableReads::requested>();
}

template <class In, class Out>
template <TableReads Access>
void Stage<In, Out>::step_with() {
    const std::uint64_t cycle = clock_.last_cycle();
    Machinery& m = *machinery_;
    if (Access == TableReads::requested)
        take_answers(cycle);
    while (m.pipeline.front_finished(cycle) && m.fork.deliver(m.pipeline.front().result)) {
        m.pipeline.pop();
        if (Access == TableReads::requested)
            --m.waiting;
        activity_.item_out(cycle);
    }
    bool lacking = false;
    while ((Access == TableReads::none || m.ask(cycle)) && !input_->empty() && m.pipeline.may_start(cycle)) {
        lacking = may_wait_ && !may_start(input_->front());
        if (lacking)
            break;
        start<Access>(cycle);
    }
    if (Access == TableReads::requested)
        m.skip_processed();
    if (m.pipeline.front_finished(cycle))
        activity_.set(cycle, State::blocked, m.fork.blocked_by());
    else if (Access == TableReads::requested && m.waiting == 0 && !m.pipeline.empty())
        activity_.set(cycle, State::waiting_for_memory, m.awaited().memory());
    else if (Access == TableReads::prompt && !m.pipeline.empty() && m.pipeline.front().answered_at > cycle)
        activity_.set_until(m.pipeline.front().answered_at, State::busy, cycle, State::waiting_for_memory,
                            m.ports[0]->memory());
    else if (!m.pipeline.empty() || (!lacking && !input_->empty()))
        activity_.set(cycle, State::busy);
    else
        activity_.set(cycle, State::starved, lacking ? awaited_unit() : nullptr);
    wake_at(m.pipeline.next_finished(cycle));
    if (!input_->empty())
        wake_at(m.pipeline.next_start(cycle, Access == TableReads::prompt ? m.asked_at : 0));
    if (Access == TableReads::prompt && lacking && m.last_answer > cycle)
        wake_at(m.last_answer);
}

}  // namespace tessera
