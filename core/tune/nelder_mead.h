#pragma once
#include <compare>
#include <functional>
#include <optional>
#include <vector>

namespace aftershade::tune {

/// In the unit cube, a coordinate an axis.
using Point = std::vector<double>;

/// How bad a point is. What breaks a constraint is worse than all that keep it, by how much it breaks it.
struct Rank {
  double excess = 0;  ///< 0: keeps the constraint
  double loss = 0;
  std::partial_ordering operator<=>(const Rank&) const = default;
};

/// Ranks a point of the cube; nullopt ends the search.
using RankOf = std::function<std::optional<Rank>(const Point&)>;

/// The simplex method of Nelder and Mead ("A simplex method for function minimization", The Computer Journal 7, 1965)
/// with the coefficients of Gao and Han ("Implementing the Nelder-Mead simplex algorithm with adaptive parameters",
/// Computational Optimization and Applications 51, 2012), which depend on the dimension. It needs only the order of
/// points, so any Rank will do. Points that leave the cube are put back onto its border (as Luersen and Le Riche do,
/// "Globalized Nelder-Mead method for engineering optimization", Computers & Structures 82, 2004). Begins with `start`
/// and the points a step (in either direction) along each axis from it; ends when the simplex is smaller than
/// `tolerance` along every axis, or when `rank` has no more to say.
void nelder_mead(const Point& start, const Point& steps, double tolerance, const RankOf& rank);

}  // namespace aftershade::tune
