#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <systemc>
#include <type_traits>

#include "modules/sockets/parts.h"
#include "modules/sockets/stream_output.h"

namespace tessera {

/// Sends one item to one or several consumers. Each receives the fields it needs and accepts them when it can. The item
/// is delivered when all have accepted.
template <class Item>
class Fork {
  public:
    static constexpr std::size_t most = 4;

    /// Adds an output for the whole item, only for these parts.
    void add(StreamOutput<Item>& output, Parts only = all_parts) { add<Item>(output, nullptr, only); }

    /// Adds an output whose item `select` makes, only for these parts.
    template <class Payload>
    void add(StreamOutput<Payload>& output, Payload (*select)(const Item&), Parts only) {
        if (count_ == most) {
            SC_REPORT_ERROR("tessera/fork", "more than four outputs");
            return;
        }
        if constexpr (std::is_same_v<Payload, Item>)
            only_output_ = count_ == 0 && only == all_parts && select == nullptr ? &output : nullptr;
        else
            only_output_ = nullptr;
        to_[count_] = std::make_unique<To<Payload>>(output, select);
        only_[count_++] = only;
    }

    /// Timed mode: offers the item on those of its outputs that have not delivered it. Returns true once all have.
    bool deliver(Item& item) {
        if (only_output_ != nullptr)
            return only_output_->deliver(item);
        bool all = true;
        for (std::size_t k = 0; k < count_; ++k) {
            const unsigned bit = 1u << k;
            if ((taken_ & bit) != 0 || !is_for(k, item))
                continue;
            if (to_[k]->deliver(item))
                taken_ |= bit;
            else
                all = false;
        }
        if (all)
            taken_ = 0;
        return all;
    }

    /// Functional mode: all outputs start at the same time; on return `delay` is that of the last to finish.
    void transport(Item& item, sc_core::sc_time& delay) {
        if (only_output_ != nullptr)
            return only_output_->transport(item, delay);
        const sc_core::sc_time start = delay;
        for (std::size_t k = 0; k < count_; ++k) {
            if (!is_for(k, item))
                continue;
            sc_core::sc_time its_delay = start;
            to_[k]->transport(item, its_delay);
            delay = std::max(delay, its_delay);
        }
    }

    /// The first consumer that has not accepted its item; null: none.
    const sc_core::sc_object* blocked_by() const {
        for (std::size_t k = 0; k < count_; ++k)
            if (const sc_core::sc_object* consumer = to_[k]->blocked_by())
                return consumer;
        return nullptr;
    }

  private:
    struct Branch {
        virtual ~Branch() = default;
        virtual bool deliver(Item& item) = 0;
        virtual void transport(Item& item, sc_core::sc_time& delay) = 0;
        virtual const sc_core::sc_object* blocked_by() const = 0;
    };

    template <class Payload>
    class To final : public Branch {
      public:
        To(StreamOutput<Payload>& output, Payload (*select)(const Item&)) : output_(output), select_(select) {}

        bool deliver(Item& item) override {
            if constexpr (std::is_same_v<Payload, Item>)
                if (select_ == nullptr)
                    return output_.deliver(item);
            if (output_.free())
                selected_ = select_(item);
            return output_.deliver(selected_);
        }
        void transport(Item& item, sc_core::sc_time& delay) override {
            if constexpr (std::is_same_v<Payload, Item>)
                if (select_ == nullptr)
                    return output_.transport(item, delay);
            Payload selected = select_(item);
            output_.transport(selected, delay);
        }
        const sc_core::sc_object* blocked_by() const override { return output_.free() ? nullptr : output_.consumer(); }

      private:
        StreamOutput<Payload>& output_;
        Payload (*select_)(const Item&);  // null: the whole item
        Payload selected_{};
    };

    bool is_for(std::size_t k, const Item& item) const {
        return only_[k] == all_parts || (only_[k] & parts_in(item)) != 0;
    }

    std::array<std::unique_ptr<Branch>, most> to_;
    std::array<Parts, most> only_{};
    std::size_t count_ = 0;
    StreamOutput<Item>* only_output_ = nullptr;  // if there is no other, and it is for all parts
    unsigned taken_ = 0;                         // outputs that have delivered the item under way, one bit each
};

}  // namespace tessera
