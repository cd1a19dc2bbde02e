#include "supervision/horizon_trust.hpp"

#include <algorithm>

#include "fmbpc/model/domain.hpp"
#include "model/process_trust.hpp"

namespace fpc {

using Eigen::Index;

void HorizonTrust::reset() {
  least_ = 1.0;
  trusted_ = horizon_ = 0;
}

void HorizonTrust::start(Index size, Index horizon) {
  least_ = 1.0;
  trusted_ = horizon_ = horizon;
  point_.resize(size);
}

/// The trust of sample k + i at point_.
void HorizonTrust::take(const TsModel& model, Index i, double threshold) {
  const double trust = trustOf(model, point_);
  if (trust < threshold) trusted_ = std::min(trusted_, i);
  least_ = std::min(least_, trust);
}

void HorizonTrust::judge(const TsModel& model, const PlanView& plan, double threshold) {
  const auto size = model.outputs.size() + model.inputs.size() + model.disturbances.size();
  start(static_cast<Index>(size), plan.plannedSteps());
  for (Index i = 1; i < horizon_; ++i) {
    plan.planned(i, point_);
    take(model, i, threshold);
  }
}

double HorizonTrust::leastOfProcess(const TsModel& model, const PlanView& plan, Index steps) {
  point_.resize(
      static_cast<Index>(model.outputs.size() + model.inputs.size() + model.disturbances.size()));
  double least = 1.0;
  for (Index i = 1; i <= std::min(steps, plan.plannedSteps() - 1); ++i) {
    plan.planned(i, point_);
    least = std::min(least, processTrustOf(model, point_));
  }
  return least;
}

void HorizonTrust::judge(const TsModel& model, const PredictiveAction& p, VectorRef disturbances,
                         double threshold) {
  const Index n_y = p.C.rows(), n_u = p.B.cols();
  start(n_y + n_u + disturbances.size(), std::max(kLeastHorizon, p.feedforward.cols()));
  state_ = p.state;
  point_.tail(disturbances.size()) = disturbances;
  for (Index i = 0; i < horizon_; ++i) {
    point_.head(n_y) = p.offset_output;
    point_.head(n_y) += p.C.lazyProduct(state_);
    point_.segment(n_y, n_u) = p.feedforward.col(std::min(i, p.feedforward.cols() - 1));
    point_.segment(n_y, n_u) -= p.K.lazyProduct(state_);
    if (i > 0) take(model, i, threshold);
    next_ = p.offset_state;
    next_ += p.A.lazyProduct(state_);
    next_ += p.B.lazyProduct(point_.segment(n_y, n_u));
    state_.swap(next_);
  }
}

}  // namespace fpc
