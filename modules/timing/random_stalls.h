#pragma once
#include <cstdint>
#include <string_view>

namespace tessera {

/// Random stalls of a channel, for tests: each item is held back with a given probability, for a random time.
struct StallParameters {
    std::uint64_t seed = 0;
    unsigned per_mille = 0;  ///< of the items; 0: never
    unsigned longest = 16;   ///< cycles, at least 1
};

/// The stalls of one channel: a sequence that depends only on the seed and the channel's name.
class RandomStalls {
  public:
    RandomStalls() = default;
    RandomStalls(const StallParameters& parameters, std::string_view channel)
        : state_(parameters.seed), per_mille_(parameters.per_mille), longest_(parameters.longest) {
        for (const char letter : channel)
            state_ = (state_ ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
    }

    /// Cycles to hold the next item back; 0: none.
    unsigned next() { return per_mille_ == 0 ? 0 : draw_next(); }

  private:
    unsigned draw_next() {
        if (draw() % 1000 >= per_mille_)
            return 0;
        return 1 + static_cast<unsigned>(draw() % longest_);
    }
    std::uint64_t draw() {  // splitmix64
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state_;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }

    std::uint64_t state_ = 0;
    unsigned per_mille_ = 0;
    unsigned longest_ = 1;
};

}  // namespace tessera
