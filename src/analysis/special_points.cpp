// Where something changes along a branch: folds, Hopf points, flips, extremes of a state.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "analysis/curve.hpp"

namespace fpc {
namespace {

constexpr int kPointBisections = 60;
constexpr double kNoSlope = 1e-7;  // of a unit tangent: what differences of the field cannot tell
constexpr double kNarrowest = 1e-11;  // of the arc length, in sizes

struct Bracket {
  double low{}, high{};  // arc lengths from `from`; they differ in what is looked for
  TracedPoint at;        // near high
};

/// Halves the bracket while `changed` tells on which side the change lies.
bool bisect(const Curve& curve, const TracedPoint& from, Bracket& bracket,
            const std::function<bool(const TracedPoint&)>& changed) {
  for (int i = 0; i < kPointBisections && std::abs(bracket.high - bracket.low) > kNarrowest; ++i) {
    const double middle = 0.5 * (bracket.low + bracket.high);
    TracedPoint point;
    if (!curve.step(from, middle, point)) return false;
    if (changed(point)) {
      bracket.high = middle;
      bracket.at = point;
    } else {
      bracket.low = middle;
    }
  }
  return true;
}

/// Index of the tangent's component -> where it changes sign. A component that is nothing but
/// rounding (a state that does not depend on the parameter) has no sign.
bool findZero(const Curve& curve, const TracedPoint& from, double step, const TracedPoint& to,
              Eigen::Index i, SpecialPoint& found) {
  const bool positive = from.tangent[i] > 0.0;
  if (std::max(std::abs(from.tangent[i]), std::abs(to.tangent[i])) < kNoSlope) return false;
  if (from.tangent[i] == 0.0 || positive == (to.tangent[i] > 0.0)) return false;
  Bracket bracket{0.0, step, to};
  if (!bisect(curve, from, bracket,
              [&](const TracedPoint& p) { return (p.tangent[i] > 0.0) != positive; }))
    return false;
  found.parameter = bracket.at.at.parameter;
  found.state = bracket.at.at.state;
  return true;
}

/// The eigenvalue nearest to the border of the stable region.
std::complex<double> crossing(const Eigenvalues& values, bool map) {
  std::complex<double> nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (const auto& value : values) {
    const double d = std::abs(map ? std::abs(value) - 1.0 : value.real());
    if (d < distance) {
      distance = d;
      nearest = value;
    }
  }
  return {nearest.real(), std::abs(nearest.imag())};
}

void findCrossings(const Curve& curve, const TracedPoint& from, double step, const TracedPoint& to,
                   bool map, std::vector<SpecialPoint>& found) {
  int count = from.at.unstable;
  double low = 0.0;
  while (count != to.at.unstable) {
    Bracket bracket{low, step, to};
    const int before = count;
    if (!bisect(curve, from, bracket,
                [before](const TracedPoint& p) { return p.at.unstable != before; }))
      return;
    count = bracket.at.at.unstable;
    low = bracket.high;
    const auto value = crossing(bracket.at.at.values, map);
    const bool hopf = std::abs(count - before) == 2 && value.imag() > 0.0;
    const bool flip = map && value.imag() == 0.0 && value.real() < 0.0;
    if (hopf || flip)
      found.push_back({hopf ? SpecialKind::kHopf : SpecialKind::kFlip, bracket.at.at.parameter,
                       bracket.at.at.state, -1, value});
  }
}

}  // namespace

const std::string& name(SpecialKind kind) {
  static const std::string names[] = {"fold", "hopf", "flip", "turning point"};
  return names[static_cast<std::size_t>(kind)];
}

void findSpecialPoints(const Curve& curve, const TracedPoint& from, double step,
                       const TracedPoint& to, bool map, std::vector<SpecialPoint>& found) {
  SpecialPoint point;
  const Eigen::Index n = curve.size();
  if (findZero(curve, from, step, to, n, point)) {
    point.kind = SpecialKind::kFold;
    found.push_back(point);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    if (findZero(curve, from, step, to, i, point)) {
      point.kind = SpecialKind::kTurningPoint;
      point.turning_state = i;
      found.push_back(point);
      point.turning_state = -1;
    }
  findCrossings(curve, from, step, to, map, found);
}

}  // namespace fpc
