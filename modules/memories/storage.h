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

    /// Reads table entries, each from its address, one after another to `to`: the common sizes without a call of memcpy.
    /// Returns false, having read some, if they have another size or are not all allocated.
    bool read_entries(const std::uint64_t* addresses, unsigned count, unsigned entry_bytes, unsigned char* to) const {
        switch (entry_bytes) {
            case 2: return read_entries<2>(addresses, count, to);
            case 4: return read_entries<4>(addresses, count, to);
            case 6: return read_entries<6>(addresses, count, to);
            default: return false;
        }
    }

    /// The same, each zero-extended; of any size up to eight bytes. Returns false if one is out of range.
    bool read_entries(const std::uint64_t* addresses, unsigned count, unsigned entry_bytes, std::uint64_t* to) const {
        const std::uint64_t mask = entry_bytes >= 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * entry_bytes)) - 1;
        // Copies: to the compiler `to` could be these.
        const unsigned char* const bytes = bytes_.data();
        const std::uint64_t base = base_, whole = bytes_.size() < sizeof mask ? 0 : bytes_.size() - sizeof mask + 1;
        for (unsigned k = 0; k < count; ++k) {
            std::uint64_t entry = 0;
            if (addresses[k] - base < whole)
                std::memcpy(&entry, bytes + (addresses[k] - base), sizeof entry);
            else if (covers(addresses[k], entry_bytes))
                read(addresses[k], reinterpret_cast<unsigned char*>(&entry), entry_bytes);
            else
                return false;
            to[k] = entry & mask;
        }
        return true;
    }

    /// Only covered addresses may be read or written.
    void read(std::uint64_t address, unsigned char* to, std::size_t length) const {
        const std::uint64_t first = address - base_;
        if (first + length <= bytes_.size()) {
            std::copy_n(&bytes_[first], length, to);
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
    template <std::size_t Bytes>
    bool read_entries(const std::uint64_t* addresses, unsigned count, unsigned char* to) const {
        if (bytes_.size() < Bytes)
            return false;
        const unsigned char* const bytes = bytes_.data();
        const std::uint64_t base = base_, last = bytes_.size() - Bytes;
        for (unsigned k = 0; k < count; ++k, to += Bytes) {
            const std::uint64_t first = addresses[k] - base;
            if (first > last)
                return false;
            std::memcpy(to, bytes + first, Bytes);
        }
        return true;
    }

    std::uint64_t base_;
    std::uint64_t size_;
    std::vector<unsigned char> bytes_;
};

}  // namespace tessera
