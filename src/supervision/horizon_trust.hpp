// How far ahead a law's plan stays where its model has data.
#pragma once

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/control/plan_view.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Trust (see trustOf()) along what a law expects, one sample after the other: the plan that it
/// shows (PlanView), else its predictive action, the frozen local model under its own feedback,
/// over kLeastHorizon samples or more (the last feedforward is held). Fixed work, no allocation
/// after the first sample.
class HorizonTrust {
 public:
  void reset();
  /// Along a plan. model: matched to the plant; its domain is known.
  void judge(const TsModel& model, const PlanView& plan, double threshold);
  /// Along a prediction, with the measured disturbances held.
  void judge(const TsModel& model, const PredictiveAction& prediction, VectorRef disturbances,
             double threshold);
  /// Least trust of outputs and disturbances (processTrustOf()) over the plan's first samples.
  double leastOfProcess(const TsModel& model, const PlanView& plan, Eigen::Index steps);
  static constexpr Eigen::Index kLeastHorizon = 10;
  double least() const { return least_; }  ///< over the horizon; 1 without one
  /// Samples ahead of now before trust falls below the threshold; all of them where it does not.
  Eigen::Index trustedSteps() const { return trusted_; }
  Eigen::Index horizon() const { return horizon_; }  ///< samples that were judged

 private:
  void start(Eigen::Index size, Eigen::Index horizon);
  void take(const TsModel& model, Eigen::Index i, double threshold);

  double least_{1.0};
  Eigen::Index trusted_{}, horizon_{};
  Vector point_, state_, next_;
};

}  // namespace fpc
