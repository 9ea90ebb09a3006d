// A changed byte of a PNG is found out by its chunk's checksum before anything else looks at it. So three mutations in
// four get their checksums mended, and reach what lies behind.
#include <zlib.h>

#include <cstddef>
#include <cstdint>

// libFuzzer provides the one and asks for the other.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);  // NOLINT
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most,  // NOLINT
                                               unsigned seed);

namespace {

constexpr std::size_t signature = 8, length_and_name = 8, checksum = 4;

std::uint32_t big_endian(const std::uint8_t* bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
           bytes[3];
}

void mend_checksums(std::uint8_t* data, std::size_t size) {
    std::size_t at = signature;
    while (at <= size && size - at >= length_and_name + checksum) {
        const std::size_t length = big_endian(data + at);
        if (length > size - at - length_and_name - checksum)
            return;
        const auto sum = static_cast<std::uint32_t>(::crc32(0, data + at + 4, static_cast<uInt>(length + 4)));
        for (std::size_t k = 0; k < checksum; ++k)
            data[at + length_and_name + length + k] = static_cast<std::uint8_t>(sum >> (24 - 8 * k));
        at += length_and_name + length + checksum;
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most,  // NOLINT
                                               unsigned seed) {
    const std::size_t mutated = LLVMFuzzerMutate(data, size, most);
    if (seed % 4 != 0)
        mend_checksums(data, mutated);
    return mutated;
}
