#pragma once
#include <cstddef>
#include <vector>

namespace tessera {

/// A rational B-spline patch that elevates its parameter space (the paper's section 2.7):
///
///     height(u, v) = sum w_ij h_ij N_i(u) N_j(v) / sum w_ij N_i(u) N_j(v)
///
/// over knots_u[degree_u] <= u <= knots_u[columns], and v likewise. knots_u has columns + degree_u + 1 non-decreasing
/// entries. Column i of row j is heights[j * columns + i], model units; row 0 is at the lowest v. Weights are positive.
/// A Bezier patch has knots 0 ... 0 1 ... 1. A rational quarter circle used as a height is not a circle: u and v would
/// have to be rational, too.
struct NurbsPatch {
    std::size_t degree_u = 1, degree_v = 1;
    std::size_t columns = 0, rows = 0;
    std::vector<double> knots_u, knots_v;
    std::vector<double> heights, weights;
};

/// The basis functions that are non-zero at a parameter: values[k] is N_(first + k).
struct BasisFunctions {
    std::size_t first = 0;
    std::vector<double> values;
};

/// Uses the recursion of Cox and de Boor, with sums and products of numbers >= 0 only, so accurate to rounding. `t` is
/// in knots[degree] .. knots[knots.size() - degree - 1]; the upper end belongs to the last non-empty interval.
BasisFunctions basis_functions(const std::vector<double>& knots, std::size_t degree, double t);

double height_of(const NurbsPatch& patch, const BasisFunctions& u, const BasisFunctions& v);

/// Height at u, v in 0..1, which span the patch's parameter ranges.
double height_of(const NurbsPatch& patch, double u, double v);

/// The parameter at fraction `part`, 0..1, of the knots' range.
double parameter_at(const std::vector<double>& knots, std::size_t degree, double part);

/// Knots 0 ... 0 1 ... 1.
std::vector<double> bezier_knots(std::size_t degree);

}  // namespace tessera
