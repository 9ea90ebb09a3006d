#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "modules/stream/work.h"

namespace tessera {

/// The passes under way in timed mode. Get Triangle takes one for each triangle it starts; Pass or Tessellate or
/// Tessellation, where the pass ends, gives it back. Grows to the most that were ever under way; no allocation
/// after that.
class PassPool {
  public:
    Pass& take() {
        if (free_.empty()) {
            passes_.emplace_back();
            free_.reserve(passes_.size());
            free_.push_back(&passes_.back());
        }
        Pass& pass = *free_.back();
        free_.pop_back();
        pass = Pass{};
        pass.number = next_tag();
        return pass;
    }
    /// Functional mode, where a pass lives as long as the call that brings its triangle.
    Tag next_tag() { return next_tag_++; }
    void give_back(Pass& pass) { free_.push_back(&pass); }

    std::size_t under_way() const { return passes_.size() - free_.size(); }
    std::size_t most_under_way() const { return passes_.size(); }

  private:
    std::deque<Pass> passes_;
    std::vector<Pass*> free_;
    Tag next_tag_ = 0;
};

}  // namespace tessera
