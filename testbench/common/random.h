#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace tessera {

/// splitmix64 (Vigna, public domain): seeded; the same numbers with every compiler and library.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }

    std::int64_t integer(std::int64_t low, std::int64_t high) {
        const std::uint64_t span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
        const std::uint64_t offset = span == 0 ? bits() : bits() % span;
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + offset);
    }
    std::int32_t integer32(std::int64_t low, std::int64_t high) {
        return static_cast<std::int32_t>(integer(low, high));
    }
    std::uint32_t natural(std::uint32_t low, std::uint32_t high) {
        return static_cast<std::uint32_t>(integer(low, high));
    }

    /// A number in -limit..limit, with every bit width equally likely, since small values matter as much as large ones.
    /// One in sixteen is a limit itself.
    std::int64_t any_size(std::int64_t limit) {
        const std::uint64_t choice = bits();
        const std::int64_t magnitude =
            (choice & 15) == 0 ? limit : integer(0, limit) >> static_cast<int>((choice >> 8) % 62);
        return (choice >> 4 & 1) != 0 ? -magnitude : magnitude;
    }

    bool coin() { return (bits() >> 40 & 1) != 0; }
    bool chance(unsigned percent) { return bits() % 100 < percent; }

    /// Uniform in low..high, in steps of 2^-53 of the range.
    double real(double low, double high) { return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53); }

    template <class Value>
    Value one_of(std::initializer_list<Value> values) {
        return values.begin()[bits() % values.size()];
    }

  private:
    std::uint64_t state_;
};

}  // namespace tessera
