// Blends the rules into the matrices of one sample. Source: vallejo2019, eqs. 10-17, rewritten for
// any lags.
#include "fmbpc/model/local_model.hpp"

#include <algorithm>
#include <utility>

#include "model/firing_slopes.hpp"
#include "model/lag_state.hpp"

namespace fpc {
namespace {

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

}  // namespace

LocalModel::LocalModel(TsModel model) : model_(std::move(model)) {
  model_.validate();
  layOut();
  affine_ = AffineModel(n_x_, static_cast<Eigen::Index>(model_.inputs.size()),
                        static_cast<Eigen::Index>(model_.outputs.size()));
  last_input_ = Vector::Zero(static_cast<Eigen::Index>(model_.inputs.size()));
  fillShifts();
  firing_.resize(model_.submodels.size());
  for (std::size_t i = 0; i < model_.submodels.size(); ++i) {
    firing_[i].weights = Vector::Zero(static_cast<Eigen::Index>(model_.submodels[i].rules.size()));
    const auto place = [this](const std::vector<Regressor>& variables,
                              std::vector<std::vector<Place>>& places,
                              std::vector<Vector>& values) {
      places.emplace_back();
      for (const Regressor& variable : variables) places.back().push_back(placeOf(variable));
      values.emplace_back(Vector::Zero(static_cast<Eigen::Index>(variables.size())));
    };
    place(model_.submodels[i].antecedents, antecedents_, antecedent_values_);
    place(model_.submodels[i].regressors, regressors_, regressor_values_);
    slopes_.emplace_back(Matrix::Zero(firing_[i].weights.size(), antecedent_values_[i].size()));
  }
}

void LocalModel::layOut() {
  const auto place = [this](SignalKind kind, int extra, int least,
                            std::vector<Eigen::Index>& offset, std::vector<int>& lags) {
    const auto count = model_.signals(kind).size();
    for (std::size_t i = 0; i < count; ++i) {
      offset.push_back(n_x_);
      lags.push_back(std::max(model_.maxLag(kind, static_cast<int>(i)) + extra, least));
      n_x_ += lags.back();
    }
  };
  place(SignalKind::kOutput, 1, 1, output_offset_, output_lags_);
  place(SignalKind::kInput, 0, 1, input_offset_, input_lags_);
  place(SignalKind::kDisturbance, 0, 0, disturbance_offset_, disturbance_lags_);
  place(SignalKind::kUnmeasured, 1, 1, unmeasured_offset_, unmeasured_lags_);
}

Eigen::Index LocalModel::outputState(Eigen::Index output, int lag) const {
  return output_offset_[at(output)] + lag;
}
Eigen::Index LocalModel::inputState(Eigen::Index input, int lag) const {
  return input_offset_[at(input)] + lag - 1;
}
Eigen::Index LocalModel::disturbanceState(Eigen::Index disturbance, int lag) const {
  return disturbance_offset_[at(disturbance)] + lag - 1;
}
Eigen::Index LocalModel::unmeasuredState(Eigen::Index disturbance, int lag) const {
  return unmeasured_offset_[at(disturbance)] + lag;
}

void LocalModel::restState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                           Eigen::Ref<Vector> state) const {
  for (std::size_t i = 0; i < output_lags_.size(); ++i)
    state.segment(output_offset_[i], output_lags_[i])
        .setConstant(outputs[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < input_lags_.size(); ++i)
    state.segment(input_offset_[i], input_lags_[i])
        .setConstant(input[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < disturbance_lags_.size(); ++i)
    state.segment(disturbance_offset_[i], disturbance_lags_[i])
        .setConstant(disturbances[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < unmeasured_lags_.size(); ++i)
    state.segment(unmeasured_offset_[i], unmeasured_lags_[i]).setZero();
}

void LocalModel::shiftState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                            Eigen::Ref<Vector> state) const {
  for (std::size_t i = 0; i < output_lags_.size(); ++i)
    pushNewest(state, output_offset_[i], output_lags_[i], outputs[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < input_lags_.size(); ++i)
    pushNewest(state, input_offset_[i], input_lags_[i], input[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < disturbance_lags_.size(); ++i)
    pushNewest(state, disturbance_offset_[i], disturbance_lags_[i],
               disturbances[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < unmeasured_lags_.size(); ++i)
    pushNewest(state, unmeasured_offset_[i], unmeasured_lags_[i], state[unmeasured_offset_[i]]);
}

void LocalModel::fillShifts() {
  const auto shift = [this](Eigen::Index first, int count) {
    for (Eigen::Index row = first + 1; row < first + count; ++row) affine_.A(row, row - 1) = 1.0;
  };
  for (std::size_t i = 0; i < output_lags_.size(); ++i) {
    shift(output_offset_[i], output_lags_[i]);
    affine_.C(static_cast<Eigen::Index>(i), output_offset_[i]) = 1.0;
  }
  for (std::size_t i = 0; i < input_lags_.size(); ++i) {
    shift(input_offset_[i], input_lags_[i]);
    affine_.B(input_offset_[i], static_cast<Eigen::Index>(i)) = 1.0;
  }
  for (std::size_t i = 0; i < disturbance_lags_.size(); ++i)
    shift(disturbance_offset_[i], disturbance_lags_[i]);
  for (std::size_t i = 0; i < unmeasured_lags_.size(); ++i) {
    shift(unmeasured_offset_[i], unmeasured_lags_[i]);
    affine_.A(unmeasured_offset_[i], unmeasured_offset_[i]) = 1.0;
  }
}

LocalModel::Place LocalModel::placeOf(const Regressor& variable) const {
  Place place{-1, variable.index, variable.kind == SignalKind::kInput};
  if (variable.kind == SignalKind::kOutput)
    place.row = outputState(variable.index, variable.lag);
  else if (variable.kind == SignalKind::kUnmeasured)
    place.row = unmeasuredState(variable.index, variable.lag);
  else if (variable.lag > 0)
    place.row = place.of_input ? inputState(variable.index, variable.lag)
                               : disturbanceState(variable.index, variable.lag);
  return place;
}

double LocalModel::value(const Place& place, VectorRef state, VectorRef input,
                         VectorRef disturbances) {
  if (place.row >= 0) return state[place.row];
  return place.of_input ? input[place.index] : disturbances[place.index];
}

void LocalModel::addTerm(Eigen::Index row, const Place& regressor, double coefficient,
                         VectorRef disturbances) {
  if (regressor.row >= 0)
    affine_.A(row, regressor.row) += coefficient;
  else if (regressor.of_input)
    affine_.B(row, regressor.index) += coefficient;
  else
    affine_.g[row] += coefficient * disturbances[regressor.index];
}

bool LocalModel::blendOutput(Eigen::Index output, VectorRef state, VectorRef input,
                             VectorRef disturbances) {
  const OutputModel& submodel = model_.submodels[at(output)];
  Vector& values = antecedent_values_[at(output)];
  for (std::size_t i = 0; i < submodel.antecedents.size(); ++i)
    values[static_cast<Eigen::Index>(i)] =
        value(antecedents_[at(output)][i], state, input, disturbances);
  FiringResult& firing = firing_[at(output)];
  const Eigen::Index row = outputState(output);
  // Weights are 0 before the first time. Without antecedents A and B are what they were then.
  const bool same = values.size() == 0 && firing.weights.sum() > 0.0;
  if (!same) {
    firingWeights(submodel, values, firing);
    affine_.A.row(row).setZero();
    affine_.B.row(row).setZero();
  }
  affine_.g[row] = 0.0;
  for (std::size_t r = 0; r < submodel.rules.size(); ++r)
    affine_.g[row] += firing.weights[static_cast<Eigen::Index>(r)] * submodel.rules[r].offset;
  for (std::size_t i = 0; i < submodel.regressors.size(); ++i) {
    const Place& regressor = regressors_[at(output)][i];
    if (same && (regressor.row >= 0 || regressor.of_input)) continue;
    double coefficient = 0.0;
    for (std::size_t r = 0; r < submodel.rules.size(); ++r)
      coefficient += firing.weights[static_cast<Eigen::Index>(r)] *
                     submodel.rules[r].coefficients[static_cast<Eigen::Index>(i)];
    addTerm(row, regressor, coefficient, disturbances);
  }
  return firing.fired;
}

bool LocalModel::blend(VectorRef state, VectorRef disturbances) {
  for (Eigen::Index i = 0; i < last_input_.size(); ++i) last_input_[i] = state[inputState(i, 1)];
  return blend(state, last_input_, disturbances);
}

bool LocalModel::blend(VectorRef state, VectorRef input, VectorRef disturbances) {
  bool fired = true;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(model_.outputs.size()); ++i)
    fired = blendOutput(i, state, input, disturbances) && fired;
  for (std::size_t i = 0; i < disturbance_lags_.size(); ++i)
    if (disturbance_lags_[i] > 0)
      affine_.g[disturbance_offset_[i]] = disturbances[static_cast<Eigen::Index>(i)];
  return fired;
}

void LocalModel::addSlopes(VectorRef state, VectorRef input, VectorRef disturbances, Matrix& A,
                           Matrix& B) {
  for (std::size_t o = 0; o < model_.submodels.size(); ++o) {
    const OutputModel& submodel = model_.submodels[o];
    if (submodel.antecedents.empty()) continue;
    Matrix& slopes = slopes_[o];
    firingSlopes(submodel, antecedent_values_[o], firing_[o], slopes);
    Vector& values = regressor_values_[o];
    for (Eigen::Index j = 0; j < values.size(); ++j)
      values[j] = value(regressors_[o][at(j)], state, input, disturbances);
    for (std::size_t r = 0; r < submodel.rules.size(); ++r) {
      const Vector& coefficients = submodel.rules[r].coefficients;
      double consequent = submodel.rules[r].offset;
      for (Eigen::Index j = 0; j < values.size(); ++j) consequent += coefficients[j] * values[j];
      for (Eigen::Index i = 0; i < slopes.cols(); ++i)
        slopes(static_cast<Eigen::Index>(r), i) *= consequent;
    }
    const Eigen::Index row = outputState(static_cast<Eigen::Index>(o));
    for (std::size_t i = 0; i < submodel.antecedents.size(); ++i) {
      const Place& z = antecedents_[o][i];
      const double slope = slopes.col(static_cast<Eigen::Index>(i)).sum();
      if (z.row >= 0)
        A(row, z.row) += slope;
      else if (z.of_input)
        B(row, z.index) += slope;
    }
  }
}

void LocalModel::advance(VectorRef state, VectorRef input, VectorRef disturbances, Vector& next) {
  blend(state, input, disturbances);
  next = affine_.g;
  next += affine_.A.lazyProduct(state);
  next += affine_.B.lazyProduct(input);
}

}  // namespace fpc
