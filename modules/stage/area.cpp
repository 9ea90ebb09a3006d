#include "modules/stage/area.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tessera {

void Area::multiply(const datapath::Multiplications& multiplications, unsigned interval, unsigned copies) {
    std::vector<datapath::OperandWidths> widest(multiplications.begin(), multiplications.end());
    std::sort(widest.begin(), widest.end(), [](const auto& a, const auto& b) {
        return std::pair(a.first * a.second, a) > std::pair(b.first * b.second, b);
    });
    for (std::size_t k = 0; k < widest.size(); k += interval)
        multipliers[widest[k]] += copies;
}

Area& Area::operator+=(const Area& more) {
    for (const auto& [widths, of_these] : more.multipliers)
        multipliers[widths] += of_these;
    register_bits += more.register_bits;
    memory_bits += more.memory_bits;
    ports += more.ports;
    return *this;
}

std::uint64_t Area::multiplier_count() const {
    std::uint64_t count = 0;
    for (const auto& [widths, of_these] : multipliers)
        count += of_these;
    return count;
}

std::uint64_t Area::partial_product_bits() const {
    std::uint64_t bits = 0;
    for (const auto& [widths, of_these] : multipliers)
        bits += of_these * static_cast<std::uint64_t>(widths.first) * static_cast<std::uint64_t>(widths.second);
    return bits;
}

}  // namespace tessera
