#pragma once
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tessera {

/// Hashes a sequence of words, word by word from 0; identical on every machine. For tables, and for sums that are
/// compared.
constexpr std::uint64_t mix_hash(std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
}

/// Packs two signed numbers into a word to hash.
constexpr std::uint64_t hash_word(std::int32_t high, std::int32_t low) {
    return std::uint64_t{static_cast<std::uint32_t>(high)} << 32 | static_cast<std::uint32_t>(low);
}

/// The bits of x, with -0 as +0: equal values have equal bits.
inline std::uint64_t alike_bits(double x) {
    const double positive_zero = x + 0.0;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &positive_zero, sizeof bits);
    return bits;
}

/// The hash of x, y and z: equal points have equal hashes.
template <class Point>
std::uint64_t point_hash(const Point& p) {
    return mix_hash(mix_hash(mix_hash(0, alike_bits(p.x)), alike_bits(p.y)), alike_bits(p.z));
}

/// 64-bit FNV-1a, byte by byte; used for recorded hashes.
constexpr std::uint64_t fnv1a_basis = 0xcbf29ce484222325u;
constexpr std::uint64_t fnv1a(std::uint64_t hash, std::uint64_t byte) {
    return (hash ^ byte) * 0x100000001b3u;
}
constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = fnv1a_basis) {
    for (const char c : bytes)
        hash = fnv1a(hash, static_cast<unsigned char>(c));
    return hash;
}

}  // namespace tessera
