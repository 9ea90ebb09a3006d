#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera::fuzz {

/// Numbers from a fuzzer's bytes, in order; zeros follow the last byte. The same bytes give the same numbers on every
/// platform.
class ByteSource {
  public:
    explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

    bool at_end() const { return next_ >= bytes_.size(); }

    std::uint8_t byte() { return at_end() ? std::uint8_t{0} : static_cast<std::uint8_t>(bytes_[next_++]); }

    std::uint64_t word(int bytes) {
        std::uint64_t word = 0;
        for (int k = 0; k < bytes; ++k)
            word |= std::uint64_t{byte()} << (8 * k);
        return word;
    }

    bool flag() { return (byte() & 1) != 0; }

    /// A number in low..high, from as many bytes as needed. The first byte also selects each limit with a probability
    /// of 1/16, since faults are likely there.
    std::int64_t integer(std::int64_t low, std::int64_t high) {
        const std::uint64_t span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
        if (span < 16)
            return low + static_cast<std::int64_t>(byte() % (span + 1));
        const unsigned choice = byte() & 15u;
        if (choice == 0)
            return low;
        if (choice == 15)
            return high;
        const int bytes = span >> 8 == 0 ? 1 : span >> 16 == 0 ? 2 : span >> 32 == 0 ? 4 : 8;
        const std::uint64_t offset = span == UINT64_MAX ? word(bytes) : word(bytes) % (span + 1);
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + offset);
    }
    std::int32_t integer32(std::int64_t low, std::int64_t high) {
        return static_cast<std::int32_t>(integer(low, high));
    }
    std::uint32_t natural(std::int64_t low, std::int64_t high) {
        return static_cast<std::uint32_t>(integer(low, high));
    }

  private:
    std::string_view bytes_;
    std::size_t next_ = 0;
};

}  // namespace tessera::fuzz
