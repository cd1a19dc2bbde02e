// Source: blazic2007, eqs. 13, 14, 23.
#include "control/fmbpc/smith_predictor.hpp"

#include <utility>

namespace fpc {

SmithPredictor::SmithPredictor(LocalModel local, std::optional<CanonicalForm> canonical, int delay)
    : local_(std::move(local)),
      canonical_(std::move(canonical)),
      rest_(Vector::Zero(local_.stateSize())),
      state_(Vector::Zero(affine().g.size())),
      next_(state_),
      disturbance_(Vector::Zero(static_cast<Eigen::Index>(local_.model().disturbances.size()))),
      inputs_(Matrix::Zero(affine().B.cols(), delay)),
      disturbances_(Matrix::Zero(disturbance_.size(), delay)) {}

void SmithPredictor::rest(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  inputs_.colwise() = Vector::Map(input.data(), input.size());
  disturbances_.colwise() = Vector::Map(disturbances.data(), disturbances.size());
  local_.restState(outputs, input, disturbances, rest_);
  if (canonical_) {
    local_.blend(rest_, disturbances);
    canonical_->blend(local_.firing().front());
    canonical_->restState(input[0], state_);
  } else {
    state_ = rest_;
  }
}

void SmithPredictor::predict() {
  next_ = affine().g;
  next_.noalias() += affine().A * state_;
  next_.noalias() += affine().B * inputs_.col(oldest_input_);
}

void SmithPredictor::foresee(Eigen::Ref<Vector> y) {
  predict();
  y.noalias() = affine().C.lazyProduct(next_);
}

void SmithPredictor::advance(VectorRef input) {
  predict();
  state_.swap(next_);
  inputs_.col(oldest_input_) = input;
  oldest_input_ = (oldest_input_ + 1) % inputs_.cols();
}

void SmithPredictor::blend(VectorRef disturbances, const Vector* antecedents) {
  disturbance_ = disturbances_.col(oldest_disturbance_);
  disturbances_.col(oldest_disturbance_) = disturbances;
  oldest_disturbance_ = (oldest_disturbance_ + 1) % disturbances_.cols();
  local_.blend(antecedents ? *antecedents : state_, disturbance_);
  if (canonical_) canonical_->blend(local_.firing().front());
}

void SmithPredictor::output(Eigen::Ref<Vector> y) const {
  if (canonical_) {
    y.noalias() = canonical_->affine().C * state_;
    return;
  }
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = state_[local_.outputState(i)];
}

}  // namespace fpc
