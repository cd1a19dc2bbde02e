#include "supervision/promise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fpc {

using Eigen::Index;

ErrorPromise::ErrorPromise(Index window, Vector floor)
    : squares_(Matrix::Zero(floor.size(), window)),
      changes_(Vector::Zero(window)),
      mean_(Vector::Zero(floor.size())),
      promised_(mean_),
      floor_(std::move(floor)) {}

void ErrorPromise::add(VectorRef squares, double change, bool promises) {
  const Index window = squares_.cols();
  for (Index i = 0; i < squares.size(); ++i)
    squares_(i, place_) = std::isfinite(squares[i]) ? squares[i] : 0.0;
  changes_[place_] = std::isfinite(change) ? change : 0.0;
  place_ = (place_ + 1) % window;
  filled_ = std::min(filled_ + 1, window);
  mean_ = squares_.rowwise().sum() / static_cast<double>(window);
  change_ = changes_.maxCoeff();
  if (!promises || filled_ < window) return;
  promised_ = promised_.cwiseMax(mean_);
  promised_change_ = std::max(promised_change_, change_);
  known_ = true;
}

Index ErrorPromise::broken() const {
  if (!known_) return -1;
  double factor = 1.0;
  if (change_ > promised_change_) {
    if (!(promised_change_ > 0.0)) return -1;
    factor = std::pow(change_ / promised_change_, 2.0);
  }
  for (Index i = 0; i < mean_.size(); ++i)
    if (mean_[i] > kLeaves * factor * promised_[i] + floor_[i]) return i;
  return -1;
}

}  // namespace fpc
