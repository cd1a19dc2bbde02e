#include "fmbpc/control/bumpless_transfer.hpp"

namespace fpc {

BumplessTransfer::BumplessTransfer(Eigen::Index n_u, double decay)
    : decay_(decay), bias_(Vector::Zero(n_u)), kept_(bias_) {}

void BumplessTransfer::reset(bool pending) {
  bias_.setZero();
  pending_ = pending;
}

void BumplessTransfer::apply(VectorRef input_applied, Eigen::Ref<Vector> proposal) {
  if (!pending_ || !proposal.allFinite()) {
    proposal += bias_;
    return;
  }
  bias_ = input_applied - proposal;
  proposal = input_applied;
  pending_ = false;
}

void BumplessTransfer::begin(VectorRef input) {
  kept_ = input;
  reset(false);
}

void BumplessTransfer::finish(Eigen::Ref<Vector> proposal) {
  bias_ = kept_ - proposal;
  proposal = kept_;
}

void BumplessTransfer::addTo(Eigen::Ref<Matrix> inputs) const {
  double left = 1.0;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i, left *= decay_) inputs.col(i) += left * bias_;
}

void BumplessTransfer::fade() { bias_ *= decay_; }

}  // namespace fpc
