// A loop that pushes an input to its bound while its output moves away.
#include <algorithm>
#include <cmath>

#include "supervision/guard.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kAtBound = 1e-6;  // of the range
constexpr double kHelp = 0.01;     // of the error: what counts as smaller
constexpr Index kLeastWindow = 4;

}  // namespace

LockUpWatch::LockUpWatch(const GuardParams& params, double lower, double upper)
    : lower_(lower),
      upper_(upper),
      range_(upper - lower),
      step_(params.lock_step * range_),
      release_(std::max(1, params.lock_release)),
      past_(Vector::Zero(
          params.lock_samples > 0 ? std::max<Index>(kLeastWindow, params.lock_samples) : 0)) {}

void LockUpWatch::reset() {
  wait_ = side_ = whose_ = for_ = 0;
  drawn_ = 0.0;
  trying_ = locked_ = false;
  known_ = 0;
}

int LockUpWatch::sideOf(double applied) const {
  if (applied <= lower() + kAtBound * range_) return -1;
  return applied >= upper() - kAtBound * range_ ? 1 : 0;
}

double LockUpWatch::mean(Index from) const {
  const Index quarter = past_.size() / 4;
  return past_.segment(from, quarter).mean();
}

void LockUpWatch::open(double step) {
  drawn_ = std::max(0.0, drawn_ - step);
  if (drawn_ == 0.0) locked_ = false;
}

/// The same output, now beyond its tolerance on the other side.
bool LockUpWatch::isInTheWay(double error, int whose) const {
  return drawn_ > 0.0 && error >= 1.0 && whose != 0 && whose == -for_;
}

/// A full window at the bound: is it worth a trial?
void LockUpWatch::suspect() {
  const Index quarter = past_.size() / 4;
  const double first = mean(0), last = mean(past_.size() - quarter);
  if (last < 1.0 || last < first) {
    open(range_ / release_);
    return;
  }
  if (wait_ > 0) return;
  if (drawn_ == 0.0) for_ = whose_;
  expected_ = last + (last - first);
  drawn_ = std::min(range_, drawn_ + step_);
  trying_ = true;
  known_ = 0;
}

/// A window after a trial: did it help?
void LockUpWatch::judge() {
  const double last = mean(past_.size() - past_.size() / 4);
  trying_ = false;
  if (last < expected_ - kHelp * std::abs(expected_)) {
    locked_ = true;
    return;
  }
  drawn_ = locked_ ? std::max(0.0, drawn_ - step_) : 0.0;  // the last step was one too many
  locked_ = drawn_ > 0.0;
  known_ = 0;
  wait_ = release_;
}

bool LockUpWatch::observe(double applied, double error, int whose) {
  if (past_.size() == 0 || !std::isfinite(range_) || range_ <= 0.0) return false;
  wait_ = std::max(0, wait_ - 1);
  whose_ = whose;
  if (isInTheWay(error, whose)) {
    known_ = 0;
    trying_ = false;
    open(std::max(step_ / static_cast<double>(past_.size()), range_ / release_));
    return locked_;
  }
  const int side = sideOf(applied);
  if (side == 0 || (side_ != 0 && side != side_)) {
    known_ = 0;
    trying_ = false;
    if (drawn_ > 0.0)
      open(range_ / release_);
    else
      side_ = 0;
    return locked_;
  }
  side_ = side;
  if (known_ == past_.size()) {
    for (Index i = 0; i + 1 < known_; ++i) past_[i] = past_[i + 1];
    past_[known_ - 1] = error;
  } else {
    past_[known_++] = error;
  }
  if (known_ < past_.size()) return locked_;
  if (trying_) judge();
  if (known_ == past_.size() && !trying_) suspect();
  return locked_;
}

}  // namespace fpc
