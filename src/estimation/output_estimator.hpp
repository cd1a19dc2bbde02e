// Outputs of a fuzzy model that nobody measures, estimated from those that are.
#pragma once

#include <vector>

#include "estimation/estimator_params.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// Extended Kalman filter over the state of a Takagi-Sugeno model: the outputs that are measured
/// correct all of it. Jacobians from differences, the rules blended anew, so that weights that
/// change with a state count. x(k+1) = f(x, u, d) + w on the rows of the outputs; y = C x + v.
/// Source: jazwinski1970, section 8.3; scalar updates one output after the other, since the noises
/// are independent. Per sample rest() or advance(); no allocation after construction.
/// Symbols: P covariance of the state, Q of w, R of v.
class OutputEstimator {
 public:
  /// model: matched to the plant. @throws InputError of EstimatorParams.
  OutputEstimator(const TsModel& model, EstimatorParams params);
  /// Everything has rested at these values, what is not measured at params.initial.
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances);
  /// As rest(), but what is not measured stays as it was estimated last.
  void resume(VectorRef outputs, VectorRef input, VectorRef disturbances);
  /// To sample k: y(k), u(k-1), d(k-1). Values of outputs that are not measured are not looked at.
  void advance(VectorRef outputs, VectorRef input, VectorRef disturbances);
  double estimate(Eigen::Index output) const;   ///< of any output, after the correction
  double deviation(Eigen::Index output) const;  ///< its standard deviation, as the filter sees it

 private:
  void start(VectorRef outputs, VectorRef input, VectorRef disturbances);
  void predict(VectorRef input, VectorRef disturbances);
  void move(VectorRef input, VectorRef disturbances, Vector& state);
  void correct(Eigen::Index output, double measured);
  bool isMeasured(Eigen::Index output) const { return measured_[static_cast<std::size_t>(output)]; }

  LocalModel local_;
  EstimatorParams params_;
  std::vector<bool> measured_;
  Vector state_, next_, moved_, gain_, known_;
  Matrix F_, P_, FP_;
};

}  // namespace fpc
