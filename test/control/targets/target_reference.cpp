#include "control/targets/target_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kInside = 1e-8;
constexpr int kMost = 8;  // unknowns and active sides

/// normal . x <= limit. One that only divides the ways in which rows can lie may not pull.
struct HalfSpace {
  Vector normal;
  double limit;
  bool divides;
};
using Sides = std::vector<HalfSpace>;

void add(Sides& sides, const Vector& normal, double lower, double upper, bool divides = false) {
  if (std::isfinite(upper)) sides.push_back({normal, upper, divides});
  if (std::isfinite(lower)) sides.push_back({-normal, -lower, divides});
}

bool holds(const Sides& sides, const Vector& x) {
  return std::all_of(sides.begin(), sides.end(), [&](const HalfSpace& s) {
    return s.normal.dot(x) <= s.limit + kInside * (1.0 + s.normal.norm());
  });
}

/// Gauss with pivoting of a (n n+1), in place; false if it is singular.
bool eliminate(std::array<std::array<double, kMost + 1>, kMost>& a, int n) {
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int r = c + 1; r < n; ++r)
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    if (std::abs(a[pivot][c]) < 1e-9) return false;
    std::swap(a[c], a[pivot]);
    for (int r = 0; r < n; ++r) {
      if (r == c || a[r][c] == 0.0) continue;
      const double factor = a[r][c] / a[c][c];
      for (int k = c; k <= n; ++k) a[r][k] -= factor * a[c][k];
    }
  }
  for (int r = 0; r < n; ++r) a[r][n] /= a[r][r];
  return true;
}

/// Whether x is the least of 1/2 x'Hx + g'x with these sides active.
bool leastOn(const Matrix& H, const Vector& g, const Sides& sides, const std::vector<int>& set,
             Vector& x) {
  const int n = static_cast<int>(g.size()), k = static_cast<int>(set.size());
  std::array<std::array<double, kMost + 1>, kMost> a{};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a[i][j] = H(i, j);
    a[i][n + k] = -g[i];
  }
  for (int i = 0; i < k; ++i) {
    const HalfSpace& s = sides[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])];
    for (int j = 0; j < n; ++j) a[n + i][j] = a[j][n + i] = s.normal[j];
    a[n + i][n + k] = s.limit;
  }
  if (!eliminate(a, n + k)) return false;
  for (int i = 0; i < k; ++i) {
    const double pull = a[n + i][n + k];
    const bool divides = sides[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])].divides;
    if (pull < -1e-8 || (divides && pull > 1e-8)) return false;
  }
  for (int j = 0; j < n; ++j) x[j] = a[j][n + k];
  return holds(sides, x);
}

/// Of all sets of at most n sides the first that gives the least; false if none does.
bool least(const Matrix& H, const Vector& g, const Sides& sides, std::vector<int>& set, int first,
           Vector& x) {
  if (leastOn(H, g, sides, set, x)) return true;
  if (static_cast<Index>(set.size()) == g.size()) return false;
  for (int i = first; i < static_cast<int>(sides.size()); ++i) {
    set.push_back(i);
    if (least(H, g, sides, set, i + 1, x)) return true;
    set.pop_back();
  }
  return false;
}

/// Rows of one rank. In each of the 3^r ways in which they can lie (inside, above, below) the sum
/// is one quadratic; the way whose least lies as it says has the least of all, as the sum is
/// convex.
Vector leastGivenUp(const TargetProblem& p, const std::vector<Index>& rows, const Sides& allowed) {
  const Index n = p.price.size();
  int ways = 1;
  for (std::size_t i = 0; i < rows.size(); ++i) ways *= 3;
  for (int way = 0; way < ways; ++way) {
    Matrix H = Matrix::Zero(n, n);
    Vector g = Vector::Zero(n), x(n);
    Sides sides = allowed;
    bool possible = true;
    int code = way;
    for (const Index row : rows) {
      const int lies = code % 3;
      code /= 3;
      const Vector a = p.rows.row(row).transpose();
      const double lower = p.row_lower[row], upper = p.row_upper[row];
      if (lies == 0) {
        add(sides, a, lower, upper, true);
        continue;
      }
      const double limit = lies == 1 ? upper : lower;
      possible = possible && std::isfinite(limit);
      const double weight = 1.0 / (p.row_unit[row] * p.row_unit[row]);
      H += weight * a * a.transpose();
      g -= weight * limit * a;
      add(sides, a, lies == 1 ? upper : -kInfinity, lies == 1 ? kInfinity : lower, true);
    }
    std::vector<int> set;
    if (possible && least(H, g, sides, set, 0, x)) return x;
  }
  throw std::logic_error("no point inside what must hold");
}

void eachVertex(const Sides& sides, std::vector<int>& set, int first, Index n, const Vector& price,
                double& cost) {
  if (static_cast<Index>(set.size()) == n) {
    Vector x(n);
    std::array<std::array<double, kMost + 1>, kMost> a{};
    for (int i = 0; i < static_cast<int>(n); ++i) {
      const HalfSpace& s = sides[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])];
      for (int j = 0; j < static_cast<int>(n); ++j) a[i][j] = s.normal[j];
      a[i][static_cast<std::size_t>(n)] = s.limit;
    }
    if (!eliminate(a, static_cast<int>(n))) return;
    for (int j = 0; j < static_cast<int>(n); ++j) x[j] = a[j][static_cast<std::size_t>(n)];
    if (holds(sides, x)) cost = std::min(cost, price.dot(x));
    return;
  }
  for (int i = first; i < static_cast<int>(sides.size()); ++i) {
    set.push_back(i);
    eachVertex(sides, set, i + 1, n, price, cost);
    set.pop_back();
  }
}

}  // namespace

TargetReference bruteForce(const TargetProblem& p) {
  const Index n = p.price.size(), m = p.row_lower.size();
  TargetReference found{Vector::Zero(m), 0.0, Vector::Zero(n)};
  Sides allowed;
  for (Index i = 0; i < n; ++i) add(allowed, Vector::Unit(n, i), p.lower[i], p.upper[i]);
  for (int rank = 1; rank <= 5; ++rank) {
    std::vector<Index> rows;
    for (Index i = 0; i < m; ++i)
      if (p.rank[static_cast<std::size_t>(i)] == rank) rows.push_back(i);
    if (rows.empty()) continue;
    const Vector x = leastGivenUp(p, rows, allowed);
    for (const Index row : rows) {
      const double at = p.rows.row(row).dot(x);
      const double lower = p.row_lower[row], upper = p.row_upper[row];
      if (at > upper + kInside) found.given_up[row] = at - upper;
      if (at < lower - kInside) found.given_up[row] = at - lower;
      add(allowed, p.rows.row(row).transpose(), std::min(lower, at), std::max(upper, at));
    }
  }
  if (p.price.any()) {
    found.least_cost = kInfinity;
    std::vector<int> set;
    eachVertex(allowed, set, 0, n, p.price, found.least_cost);
    allowed.push_back({p.price, found.least_cost + p.band, false});
  }
  const Matrix H = p.unit.cwiseProduct(p.unit).cwiseInverse().asDiagonal();
  std::vector<int> set;
  if (!least(H, -H * p.rest, allowed, set, 0, found.v)) throw std::logic_error("no rest");
  return found;
}

}  // namespace fpc
