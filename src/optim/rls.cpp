// Potter's square-root form of recursive least squares (bierman1977, sec. V.3) with forgetting.
#include "optim/rls.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kTracePowerIterations =
    8;  // towards the direction of largest variance; PSD whatever they reach

}  // namespace

void RlsParams::validate() const {
  require(forgetting > 0.0 && forgetting <= 1.0, "forgetting", "a number in (0, 1]");
  require(std::isfinite(initial_covariance) && initial_covariance > 0.0, "initial_covariance",
          "a number > 0");
  require(std::isfinite(covariance_bound) && covariance_bound >= initial_covariance,
          "covariance_bound", "a number that is not below initial_covariance");
}

RecursiveLeastSquares::RecursiveLeastSquares(const Vector& theta_0, const RlsParams& params)
    : params_(params),
      projected_(theta_0.size()),
      gain_(theta_0.size()),
      root_(theta_0.size(), theta_0.size()) {
  params_.validate();
  reset(theta_0);
}

void RecursiveLeastSquares::reset(VectorRef theta_0) {
  require(theta_0.size() > 0 && theta_0.size() == root_.rows(), "theta_0",
          "one value for each regressor");
  require(theta_0.allFinite(), "theta_0", "finite values");
  theta_ = theta_0;
  root_.setZero();
  root_.diagonal().setConstant(std::sqrt(params_.initial_covariance));
}

bool RecursiveLeastSquares::update(VectorRef x, double y, double weight) {
  if (x.size() != theta_.size() || !x.allFinite() || !std::isfinite(y) || !std::isfinite(weight)) {
    ++skipped_;
    return false;
  }
  if (weight <= 0.0) return false;
  const double forgetting = 1.0 - weight * (1.0 - params_.forgetting);
  projected_.noalias() = root_.transpose() * x;
  const double noise = forgetting / weight;
  const double spread = noise + projected_.squaredNorm();
  gain_.noalias() = root_ * projected_;  // P x
  theta_ += gain_ * ((y - x.dot(theta_)) / spread);
  const double shrink = 1.0 / (spread + std::sqrt(noise * spread));
  root_.noalias() -= gain_ * (shrink * projected_.transpose());
  if (forgetting < 1.0) {
    root_ /= std::sqrt(forgetting);
    boundCovariance();
  }
  return true;
}

/// Shrinks S along the direction of largest variance only: what the data do determine keeps its own
/// forgetting.
void RecursiveLeastSquares::boundCovariance() {
  for (Eigen::Index turn = 0; turn < theta_.size(); ++turn) {
    Eigen::Index widest = 0;
    const double largest = root_.rowwise().squaredNorm().maxCoeff(&widest);
    if (largest <= params_.covariance_bound) return;
    if (turn == 0) ++bounded_;
    gain_.setZero();
    gain_[widest] = 1.0;
    double variance = largest;
    for (int i = 0; i < kTracePowerIterations; ++i) {
      projected_.noalias() = root_.transpose() * gain_;
      gain_.noalias() = root_ * projected_;
      variance = gain_.norm();
      gain_ /= variance;
    }
    projected_.noalias() = root_.transpose() * gain_;
    root_.noalias() -=
        (1.0 - std::sqrt(params_.covariance_bound / variance)) * gain_ * projected_.transpose();
  }
  const double largest = root_.rowwise().squaredNorm().maxCoeff();
  if (largest > params_.covariance_bound) root_ *= std::sqrt(params_.covariance_bound / largest);
}

}  // namespace fpc
