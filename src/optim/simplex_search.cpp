#include "optim/simplex_search.hpp"

#include <algorithm>
#include <vector>

namespace fpc {
namespace {

constexpr double kAll = kInfinity;  // every value is asked for

struct Corner {
  Vector x;
  double value{};
};

}  // namespace

Vector simplexSearch(const Vector& start, int evaluations, const SimplexCost& f) {
  int left = evaluations;
  const auto at = [&](const Vector& x, double least) {
    --left;
    return Corner{x, f(x, least)};
  };
  std::vector<Corner> corners{at(start, kAll)};
  for (Eigen::Index axis = 0; axis < start.size(); ++axis)
    corners.push_back(at(start + Vector::Unit(start.size(), axis), kAll));
  const auto order = [&] {
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner& p, const Corner& q) { return p.value < q.value; });
  };
  for (order(); left > 0; order()) {
    Corner& last = corners.back();
    const Corner &first = corners.front(), &second = corners[corners.size() - 2];
    Vector middle = Vector::Zero(start.size());
    for (const Corner& corner : corners)
      if (&corner != &last) middle += corner.x / static_cast<double>(start.size());
    const Vector away = middle - last.x;
    const Corner reflected = at(middle + away, last.value);
    if (reflected.value < first.value) {
      const Corner farther = at(middle + 2.0 * away, reflected.value);
      last = farther.value < reflected.value ? farther : reflected;
      continue;
    }
    if (reflected.value < second.value) {
      last = reflected;
      continue;
    }
    const bool outside = reflected.value < last.value;
    const double least = std::min(reflected.value, last.value);
    const Corner nearer = at(middle + (outside ? 0.5 : -0.5) * away, least);
    if (nearer.value < least) {
      last = nearer;
      continue;
    }
    for (std::size_t k = 1; k < corners.size(); ++k)
      corners[k] = at(0.5 * (corners[k].x + first.x), kAll);
  }
  return corners.front().x;
}

}  // namespace fpc
