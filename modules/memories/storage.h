#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace tessera {

/// The bytes of a memory, at addresses [base, base + size), 0 until written. Allocated up to the highest byte written.
class Storage {
  public:
    Storage(std::uint64_t base, std::uint64_t size) : base_(base), size_(size) {}

    std::uint64_t base() const { return base_; }
    std::uint64_t size() const { return size_; }
    bool covers(std::uint64_t address, std::uint64_t length) const {
        return length <= size_ && address - base_ <= size_ - length;
    }

    /// Only covered addresses may be read or written.
    void read(std::uint64_t address, unsigned char* to, std::size_t length) const {
        const std::uint64_t first = address - base_;
        if (first + length <= bytes_.size()) {
            copy(to, &bytes_[first], length);
            return;
        }
        const std::size_t written = first < bytes_.size() ? bytes_.size() - first : 0;
        std::copy_n(bytes_.end() - static_cast<std::ptrdiff_t>(written), written, to);
        std::fill(to + written, to + length, static_cast<unsigned char>(0));
    }
    void write(std::uint64_t address, const unsigned char* from, std::size_t length) {
        const std::uint64_t first = address - base_;
        if (bytes_.size() < first + length)
            bytes_.resize(std::max<std::uint64_t>(first + length, std::min(2 * bytes_.size(), size_)));
        std::copy_n(from, length, &bytes_[first]);
    }

    /// Allocates and returns all bytes; their address is fixed from now on.
    unsigned char* all() {
        bytes_.resize(size_);
        return bytes_.data();
    }

  private:
    /// Copies a table entry without a call of memcpy: 2, 4 or 6 bytes by default.
    static void copy(unsigned char* to, const unsigned char* from, std::size_t length) {
        switch (length) {
            case 2: std::memcpy(to, from, 2); break;
            case 4: std::memcpy(to, from, 4); break;
            case 6: std::memcpy(to, from, 6); break;
            default: std::memcpy(to, from, length);
        }
    }

    std::uint64_t base_;
    std::uint64_t size_;
    std::vector<unsigned char> bytes_;
};

}  // namespace tessera
