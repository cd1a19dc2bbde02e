#include "fmbpc/control/bumpless_transfer.hpp"

namespace fpc {

BumplessTransfer::BumplessTransfer(Eigen::Index n_u, double decay)
    : decay_(decay), bias_(Vector::Zero(n_u)), kept_(bias_) {}

void BumplessTransfer::reset(bool pending) {
  bias_.setZero();
  left_ = 0.0;
  pending_ = pending;
}

bool BumplessTransfer::active() const {
  static constexpr double kNegligible = 1e-3;
  return pending_ || left_ > kNegligible;
}

void BumplessTransfer::apply(VectorRef input_applied, Eigen::Ref<Vector> proposal) {
  if (!pending_ || !proposal.allFinite()) {
    proposal += bias_;
    return;
  }
  bias_ = input_applied - proposal;
  proposal = input_applied;
  left_ = 1.0;
  pending_ = false;
}

bool BumplessTransfer::bridge(VectorRef input_applied, Eigen::Ref<Vector> proposal) {
  if (!active()) return false;
  apply(input_applied, proposal);
  fade();
  return true;
}

void BumplessTransfer::begin(VectorRef input) {
  kept_ = input;
  reset(false);
}

void BumplessTransfer::finish(Eigen::Ref<Vector> proposal) {
  bias_ = kept_ - proposal;
  left_ = 1.0;
  proposal = kept_;
}

void BumplessTransfer::addTo(Eigen::Ref<Matrix> inputs) const {
  double left = 1.0;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i, left *= decay_) inputs.col(i) += left * bias_;
}

void BumplessTransfer::fade() {
  bias_ *= decay_;
  left_ *= decay_;
}

}  // namespace fpc
