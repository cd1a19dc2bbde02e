#include "control/estimating_controller.hpp"

#include <algorithm>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {

using Eigen::Index;

EstimatingController::EstimatingController(std::unique_ptr<Controller> inside,
                                           EstimatorParams params, PlantInfo plant)
    : ControllerAround(std::move(inside), "estimator"),
      params_(std::move(params)),
      plant_(std::move(plant)) {
  params_.validate(countOf(plant_.outputs));
  require(!params_.outputs.empty(), "estimator.outputs", "at least one output");
  refreshSignals();
}

/// Another model goes on from the estimates of the one before.
void EstimatingController::setModel(const TsModel& model) {
  inside_->setModel(model);
  EstimatorParams from = params_;
  for (const Index i : params_.outputs)
    if (estimator_ && !fresh_) from.initial[i] = estimator_->estimate(i);
  estimator_.emplace(matchToPlant(model, plant_), std::move(from));
  fresh_ = true;
}

void EstimatingController::estimate(const Measurement& now) {
  const bool same_run = now.header.run_id == seen_.header.run_id;
  const Vector& y = now.outputs;
  if (fresh_ || !same_run || now.header.step < seen_.header.step)
    estimator_->rest(y, now.input_applied, now.disturbances);
  else if (now.header.step == seen_.header.step + 1)
    estimator_->advance(y, now.input_applied, disturbances_);
  else if (now.header.step > seen_.header.step)
    estimator_->resume(y, now.input_applied, now.disturbances);
  fresh_ = false;
  disturbances_ = now.disturbances;
}

/// Estimates of this sample into seen_; the same sample again moves nothing.
void EstimatingController::look(const Measurement& now) {
  if (estimator_) estimate(now);
  seen_ = now;
  for (const Index i : params_.outputs) {
    if (!estimator_) continue;
    const SignalInfo& about = plant_.outputs[static_cast<std::size_t>(i)];
    seen_.outputs[i] = std::clamp(estimator_->estimate(i), about.lower, about.upper);
  }
}

void EstimatingController::reset(const Measurement& start) {
  look(start);
  inside_->reset(seen_);
}

void EstimatingController::lookOn(const Measurement& now) {
  look(now);
  inside_->lookOn(seen_);
}

void EstimatingController::step(const Measurement& now, const SetpointSource& setpoint,
                                ControllerOutput& output) {
  look(now);
  inside_->step(seen_, setpoint, output);
  refreshSignals();
}

void EstimatingController::refreshSignals() {
  const auto& inner = inside_->signals();
  const std::size_t n = inner.size();
  if (signals_.size() != n + params_.outputs.size()) {
    signals_ = inner;
    for (const Index i : params_.outputs)
      signals_.emplace_back(plant_.outputs[static_cast<std::size_t>(i)].name + "_estimate", 0.0);
  }
  for (std::size_t i = 0; i < n; ++i) signals_[i].second = inner[i].second;
  for (std::size_t i = 0; i < params_.outputs.size() && estimator_; ++i)
    signals_[n + i].second = estimator_->estimate(params_.outputs[i]);
}

}  // namespace fpc
