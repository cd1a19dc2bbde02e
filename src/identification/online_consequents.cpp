#include "identification/online_consequents.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "model/longest_lag.hpp"

namespace fpc {
namespace {

using Eigen::Index;

Index rowOf(const TsModel& model, const Regressor& r) {
  auto row = static_cast<Index>(r.index);
  if (r.kind != SignalKind::kOutput) row += static_cast<Index>(model.outputs.size());
  if (r.kind == SignalKind::kDisturbance) row += static_cast<Index>(model.inputs.size());
  return row;
}

void setScaling(const TsModel& model, const OutputModel& submodel, Vector& shift, Vector& scale) {
  const auto n = static_cast<Index>(submodel.regressors.size());
  shift = Vector::Zero(n);
  scale = Vector::Ones(n);
  for (Index j = 0; j < n; ++j) {
    const Regressor& r = submodel.regressors[static_cast<std::size_t>(j)];
    const SignalInfo& signal = model.signals(r.kind)[static_cast<std::size_t>(r.index)];
    if (!std::isfinite(signal.lower) || !std::isfinite(signal.upper)) continue;
    shift[j] = 0.5 * (signal.lower + signal.upper);
    scale[j] = 0.5 * (signal.upper - signal.lower);
  }
}

}  // namespace

OnlineConsequents::OnlineConsequents(TsModel model, const RlsParams& params)
    : model_(std::move(model)) {
  model_.validate();
  params.validate();
  const std::size_t n_y = model_.outputs.size();
  rules_.resize(n_y);
  shift_.resize(n_y);
  scale_.resize(n_y);
  for (std::size_t i = 0; i < n_y; ++i) {
    const OutputModel& submodel = model_.submodels[i];
    const auto n = static_cast<Index>(submodel.regressors.size());
    setScaling(model_, submodel, shift_[i], scale_[i]);
    for (const auto& rule : submodel.rules) {
      Vector theta(n + 1);
      theta << rule.coefficients.cwiseProduct(scale_[i]),
          rule.offset + rule.coefficients.dot(shift_[i]);
      rules_[i].emplace_back(theta, params);
    }
    x_.push_back(Vector::Ones(n + 1));
    z_.emplace_back(static_cast<Index>(submodel.antecedents.size()));
    FiringResult firing;
    firing.weights = Vector::Zero(static_cast<Index>(submodel.rules.size()));
    firing_.push_back(firing);
  }
  past_.resize(static_cast<Index>(n_y + model_.inputs.size() + model_.disturbances.size()),
               longestLag(model_) + 1);
  forgetPast();
}

void OnlineConsequents::forgetPast() { past_.setConstant(kNaN); }

bool OnlineConsequents::take(VectorRef outputs, VectorRef input_applied, VectorRef disturbances) {
  const auto n_y = static_cast<Index>(model_.outputs.size()),
             n_u = static_cast<Index>(model_.inputs.size());
  require(outputs.size() == n_y, "outputs", "one value for each output of the model");
  require(input_applied.size() == n_u, "input_applied", "one value for each input of the model");
  require(disturbances.size() == past_.rows() - n_y - n_u, "disturbances",
          "one value for each disturbance of the model");
  past_.col(0).segment(n_y, n_u) = input_applied;
  bool learned = false;
  for (std::size_t i = 0; i < rules_.size(); ++i)
    learned = learn(i, outputs[static_cast<Index>(i)]) || learned;
  if (learned) ++samples_;
  for (Index lag = past_.cols() - 1; lag > 0; --lag) past_.col(lag) = past_.col(lag - 1);
  past_.col(0).head(n_y) = outputs;
  past_.col(0).segment(n_y, n_u).setConstant(kNaN);
  past_.col(0).tail(disturbances.size()) = disturbances;
  return learned;
}

double OnlineConsequents::value(const Regressor& r) const { return past_(rowOf(model_, r), r.lag); }

bool OnlineConsequents::learn(std::size_t output, double y) {
  const OutputModel& submodel = model_.submodels[output];
  Vector &x = x_[output], &z = z_[output];
  for (Index j = 0; j + 1 < x.size(); ++j)
    x[j] = (value(submodel.regressors[static_cast<std::size_t>(j)]) - shift_[output][j]) /
           scale_[output][j];
  for (Index j = 0; j < z.size(); ++j)
    z[j] = value(submodel.antecedents[static_cast<std::size_t>(j)]);
  if (!x.allFinite() || !z.allFinite() || !std::isfinite(y)) return false;
  firingWeights(submodel, z, firing_[output]);
  for (std::size_t r = 0; r < submodel.rules.size(); ++r)
    if (rules_[output][r].update(x, y, firing_[output].weights[static_cast<Index>(r)]))
      write(output, r);
  return true;
}

void OnlineConsequents::write(std::size_t output, std::size_t rule) {
  const Vector& theta = rules_[output][rule].theta();
  const Index n = theta.size() - 1;
  Rule& target = model_.submodels[output].rules[rule];
  target.coefficients = theta.head(n).cwiseQuotient(scale_[output]);
  target.offset = theta[n] - target.coefficients.dot(shift_[output]);
}

}  // namespace fpc
