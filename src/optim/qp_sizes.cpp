#include "optim/qp_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace fpc::qp {
namespace {

using Eigen::Index;

constexpr double kUsual = 0x1p-7;  // from here on a size counts as 1
constexpr int kLeast = -300;       // of the exponent, so that products stay finite

}  // namespace

void ScaledProblem::resize(Index n, Index m) {
  scaled_ = QpProblem(n, m);
  size_.setOnes(n);
  said_.setZero(2 * m + 3);
  low_.setZero(m);
  high_.setZero(m);
}

/// Whether at least half of all that can be said of unknown j says that it is no smaller than
/// usual: the quick answer to nearly every problem.
bool ScaledProblem::mostlyUsual(const QpProblem& p, Index j) const {
  const Index m = p.a_lower.size();
  Index usual = 0;
  for (Index i = 0; i < m; ++i) {
    const double small = kUsual * std::abs(p.A(i, j));
    if (small == 0.0) continue;
    usual += low_(i) >= small;
    usual += high_(i) >= small;
    if (2 * usual >= most_) return true;
  }
  return false;
}

double ScaledProblem::sizeOf(const QpProblem& p, Index j) {
  const double low = std::abs(p.x_lower(j)), high = std::abs(p.x_upper(j));
  const double box = std::max(low, high);
  if (std::isfinite(box) && box >= kUsual) return 1.0;
  if (!(std::isfinite(box) && box > 0.0) && mostlyUsual(p, j)) return 1.0;
  Index count = 0;
  const auto say = [&](double size) {
    if (size > 0.0 && std::isfinite(size)) said_(count++) = size;
  };
  if (!std::isfinite(box)) say(std::min(low, high));
  if (p.H(j, j) > 0.0) say(std::abs(p.g(j)) / p.H(j, j));
  for (Index i = 0; i < p.a_lower.size(); ++i) {
    const double a = std::abs(p.A(i, j));
    if (a == 0.0) continue;
    say(low_(i) / a);
    say(high_(i) / a);
  }
  double size = std::isfinite(box) && box > 0.0 ? box : kInfinity;
  if (count > 0) {
    double* middle = said_.data() + count / 2;
    std::nth_element(said_.data(), middle, said_.data() + count);
    size = std::min(size, *middle);
  }
  return size >= kUsual ? 1.0 : std::ldexp(1.0, std::max(std::ilogb(size), kLeast));
}

/// The sizes of the rows' limits; 0: none that says anything.
void ScaledProblem::readLimits(const QpProblem& p) {
  most_ = 2;  // the bound that is finite, and the cost
  for (Index i = 0; i < p.a_lower.size(); ++i) {
    const double low = std::abs(p.a_lower(i)), high = std::abs(p.a_upper(i));
    low_(i) = std::isfinite(low) ? low : 0.0;
    high_(i) = std::isfinite(high) && p.a_upper(i) != p.a_lower(i) ? high : 0.0;
    most_ += (low_(i) > 0.0) + (high_(i) > 0.0);
  }
}

bool ScaledProblem::scale(const QpProblem& given) {
  readLimits(given);
  for (Index j = 0; j < size_.size(); ++j) size_(j) = sizeOf(given, j);
  if ((size_.array() == 1.0).all()) return false;
  for (Index j = 0; j < size_.size(); ++j) {
    scaled_.H.col(j) = size_(j) * given.H.col(j).cwiseProduct(size_);
    scaled_.A.col(j) = size_(j) * given.A.col(j);
  }
  scaled_.g = given.g.cwiseProduct(size_);
  scaled_.x_lower = given.x_lower.cwiseQuotient(size_);
  scaled_.x_upper = given.x_upper.cwiseQuotient(size_);
  scaled_.a_lower = given.a_lower;
  scaled_.a_upper = given.a_upper;
  return true;
}

}  // namespace fpc::qp
