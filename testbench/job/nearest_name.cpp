#include "testbench/job/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace tessera {

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
}

std::string_view last_part(std::string_view name) {
    return name.substr(name.rfind('.') + 1);
}

}  // namespace

std::string nearest_name(std::string_view mistyped, const std::vector<std::string>& names) {
    constexpr std::size_t longest = 64;  // no longer text is near a key, and the distance would take long
    if (mistyped.size() > longest)
        return {};
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(2, mistyped.size() / 4) + 1;
    for (const std::string& name : names) {
        // A correct last part in a wrong table costs one edit.
        const std::size_t by_last_part = edit_distance(last_part(mistyped), last_part(name)) + 1;
        const bool comparable = last_part(mistyped).size() > 2 && by_last_part <= 1 + last_part(name).size() / 4;
        const std::size_t whole = edit_distance(mistyped, name);
        const std::size_t distance = comparable ? std::min(whole, by_last_part) : whole;
        if (distance < best_distance && distance < name.size()) {
            best_distance = distance;
            best = name;
        }
    }
    return best;
}

}  // namespace tessera
