#include "testbench/bake/nurbs_patch.h"

#include <algorithm>

namespace tessera {

BasisFunctions basis_functions(const std::vector<double>& knots, std::size_t degree, double t) {
    const std::size_t count = knots.size() - degree - 1;
    // The last non-empty interval that begins at t or below.
    const auto begin = knots.begin() + static_cast<std::ptrdiff_t>(degree);
    const auto end = knots.begin() + static_cast<std::ptrdiff_t>(count);
    auto above = std::upper_bound(begin, end, t);
    if (above == end)
        above = std::lower_bound(begin, end, *end);
    const auto span = static_cast<std::size_t>(above - knots.begin()) - 1;

    BasisFunctions basis{span - degree, std::vector<double>(degree + 1)};
    std::vector<double>& n = basis.values;
    n[0] = 1;
    for (std::size_t k = 1; k <= degree; ++k) {
        double carried = 0;
        for (std::size_t i = 0; i < k; ++i) {
            const double right = knots[span + 1 + i] - t, left = t - knots[span + 1 + i - k];
            const double share = n[i] / (right + left);
            n[i] = carried + right * share;
            carried = left * share;
        }
        n[k] = carried;
    }
    return basis;
}

double height_of(const NurbsPatch& patch, const BasisFunctions& u, const BasisFunctions& v) {
    double height = 0, weight = 0;
    for (std::size_t j = 0; j < v.values.size(); ++j) {
        for (std::size_t i = 0; i < u.values.size(); ++i) {
            const std::size_t k = (v.first + j) * patch.columns + u.first + i;
            const double share = u.values[i] * v.values[j] * patch.weights[k];
            height += share * patch.heights[k];
            weight += share;
        }
    }
    return height / weight;
}

double parameter_at(const std::vector<double>& knots, std::size_t degree, double part) {
    const double low = knots[degree], high = knots[knots.size() - degree - 1];
    return std::clamp((1 - part) * low + part * high, low, high);
}

double height_of(const NurbsPatch& patch, double u, double v) {
    return height_of(patch,
                     basis_functions(patch.knots_u, patch.degree_u, parameter_at(patch.knots_u, patch.degree_u, u)),
                     basis_functions(patch.knots_v, patch.degree_v, parameter_at(patch.knots_v, patch.degree_v, v)));
}

std::vector<double> bezier_knots(std::size_t degree) {
    std::vector<double> knots(2 * (degree + 1), 0.0);
    std::fill(knots.begin() + static_cast<std::ptrdiff_t>(degree + 1), knots.end(), 1.0);
    return knots;
}

}  // namespace tessera
