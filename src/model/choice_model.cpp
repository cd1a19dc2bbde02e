#include "model/choice_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "model/lag_state.hpp"

namespace fpc {
namespace {

using Eigen::Index;

// Below this the degrees have lost their relations to underflow: the log domain decides.
constexpr double kFaintest = 1e-100;

bool isPresentInput(const Regressor& variable) {
  return variable.kind == SignalKind::kInput && variable.lag == 0;
}

}  // namespace

// A zero width is an infinite slope: a crisp edge.
double ChoiceModel::Set::degree(double z) const {
  if (!straight) return std::exp(membership.logDegree(z));
  if (z < left) return std::max(1.0 - (left - z) * left_slope, 0.0);
  if (z > right) return std::max(1.0 - (z - right) * right_slope, 0.0);
  return 1.0;
}

ChoiceModel::Set ChoiceModel::makeSet(Index source, const Membership& m) {
  Set set{source, m, false, 0.0, 0.0, 0.0, 0.0};
  const auto& p = m.parameters;
  set.straight =
      m.shape == MembershipShape::kTriangular || m.shape == MembershipShape::kTrapezoidal;
  if (!set.straight) return set;
  const std::size_t right = p.size() - 2;
  set.left = p[1];
  set.right = p[right];
  set.left_slope = 1.0 / (p[1] - p[0]);
  set.right_slope = 1.0 / (p[right + 1] - p[right]);
  return set;
}

ChoiceModel::ChoiceModel(TsModel model, Matrix choices)
    : model_(std::move(model)), choices_(std::move(choices)) {
  model_.validate();
  require(choices_.rows() == static_cast<Index>(model_.inputs.size()) && choices_.cols() > 0,
          "choices", "at least one vector of " + std::to_string(model_.inputs.size()) + " inputs");
  require(choices_.allFinite(), "choices", "finite numbers");
  for (const auto& submodel : model_.submodels)
    require(!submodel.rules.front().multivariate, "model",
            "one set per antecedent: a choice model knows no multivariate memberships");
  layOut();
  source_ = Vector::Zero(n_x_ + static_cast<Index>(model_.disturbances.size()));
  next_ = Vector::Zero(static_cast<Index>(model_.outputs.size()));
  for (std::size_t i = 0; i < model_.submodels.size(); ++i) {
    compile(i);
    const OutputModel& submodel = model_.submodels[i];
    antecedents_.emplace_back(Vector::Zero(static_cast<Index>(submodel.antecedents.size())));
    firing_.emplace_back();
    firing_.back().weights = Vector::Zero(static_cast<Index>(submodel.rules.size()));
  }
}

void ChoiceModel::layOut() {
  bool has_past = false, has_disturbance = false;
  const auto place = [&](SignalKind kind, std::vector<Index>& row, std::vector<int>& lags) {
    for (std::size_t i = 0; i < model_.signals(kind).size(); ++i) {
      const int longest = model_.maxLag(kind, static_cast<int>(i));
      const bool output = kind == SignalKind::kOutput;
      has_past = has_past || longest > 0;
      has_disturbance = has_disturbance || (kind == SignalKind::kDisturbance && longest >= 0);
      row.push_back(n_x_);
      lags.push_back(output ? std::max(longest + 1, 1) : std::max(longest, 0));
      n_x_ += lags.back();
    }
  };
  place(SignalKind::kOutput, output_row_, output_lags_);
  place(SignalKind::kInput, input_row_, input_lags_);
  place(SignalKind::kDisturbance, disturbance_row_, disturbance_lags_);
  memoryless_ = !has_past && !has_disturbance;
}

Index ChoiceModel::sourceOf(const Regressor& variable) const {
  const auto i = at(variable.index);
  switch (variable.kind) {
    case SignalKind::kOutput:
      return output_row_[i] + variable.lag;
    case SignalKind::kInput:
      return variable.lag == 0 ? -1 : input_row_[i] + variable.lag - 1;
    default:
      return variable.lag == 0 ? n_x_ + variable.index : disturbance_row_[i] + variable.lag - 1;
  }
}

ChoiceModel::CompiledRule ChoiceModel::compileRule(const OutputModel& output, const Rule& rule,
                                                   int choice) const {
  CompiledRule compiled{1.0, {}, {}, rule.offset};
  for (std::size_t i = 0; i < output.antecedents.size(); ++i) {
    const Regressor& variable = output.antecedents[i];
    if (isPresentInput(variable))
      compiled.degree *= makeSet(0, rule.antecedents[i]).degree(choices_(variable.index, choice));
    else
      compiled.sets.push_back(makeSet(sourceOf(variable), rule.antecedents[i]));
  }
  std::vector<double> coefficients;
  for (std::size_t i = 0; i < output.regressors.size(); ++i) {
    const Regressor& variable = output.regressors[i];
    const double coefficient = rule.coefficients[static_cast<Index>(i)];
    if (isPresentInput(variable))
      compiled.offset += coefficient * choices_(variable.index, choice);
    else
      coefficients.push_back(coefficient);
  }
  compiled.coefficients =
      Eigen::Map<const Vector>(coefficients.data(), static_cast<Index>(coefficients.size()));
  return compiled;
}

void ChoiceModel::compile(std::size_t output) {
  const OutputModel& from = model_.submodels[output];
  Submodel submodel;
  for (const Regressor& variable : from.regressors)
    if (!isPresentInput(variable)) submodel.sources.push_back(sourceOf(variable));
  for (int choice = 0; choice < static_cast<int>(choices_.cols()); ++choice) {
    submodel.rules.emplace_back();
    for (const Rule& rule : from.rules) {
      CompiledRule compiled = compileRule(from, rule, choice);
      if (compiled.degree > 0.0) submodel.rules.back().push_back(std::move(compiled));
    }
  }
  submodels_.push_back(std::move(submodel));
}

void ChoiceModel::restState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                            Eigen::Ref<Vector> state) const {
  const auto fill = [&](const std::vector<Index>& row, const std::vector<int>& lags,
                        VectorRef values) {
    for (std::size_t i = 0; i < row.size(); ++i)
      state.segment(row[i], lags[i]).setConstant(values[static_cast<Index>(i)]);
  };
  fill(output_row_, output_lags_, outputs);
  fill(input_row_, input_lags_, input);
  fill(disturbance_row_, disturbance_lags_, disturbances);
}

void ChoiceModel::shiftState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                             Eigen::Ref<Vector> state) const {
  const auto move = [&](const std::vector<Index>& row, const std::vector<int>& lags,
                        VectorRef values) {
    for (std::size_t i = 0; i < row.size(); ++i)
      pushNewest(state, row[i], lags[i], values[static_cast<Index>(i)]);
  };
  move(output_row_, output_lags_, outputs);
  move(input_row_, input_lags_, input);
  move(disturbance_row_, disturbance_lags_, disturbances);
}

double ChoiceModel::valueOf(const Regressor& variable, int choice) const {
  return isPresentInput(variable) ? choices_(variable.index, choice) : source_[sourceOf(variable)];
}

// Where hardly any rule fires: slower, and the nearest rule stands in.
double ChoiceModel::predictFar(std::size_t output, int choice, bool& fired) {
  const OutputModel& submodel = model_.submodels[output];
  Vector& values = antecedents_[output];
  for (std::size_t i = 0; i < submodel.antecedents.size(); ++i)
    values[static_cast<Index>(i)] = valueOf(submodel.antecedents[i], choice);
  FiringResult& firing = firing_[output];
  firingWeights(submodel, values, firing);
  fired = fired && firing.fired;
  double sum = 0.0;
  for (std::size_t r = 0; r < submodel.rules.size(); ++r) {
    const Rule& rule = submodel.rules[r];
    double value = rule.offset;
    for (std::size_t i = 0; i < submodel.regressors.size(); ++i)
      value += rule.coefficients[static_cast<Index>(i)] * valueOf(submodel.regressors[i], choice);
    sum += firing.weights[static_cast<Index>(r)] * value;
  }
  return sum;
}

double ChoiceModel::predict(std::size_t output, int choice, bool& fired) {
  const Submodel& submodel = submodels_[output];
  double weights = 0.0, sum = 0.0;
  for (const CompiledRule& rule : submodel.rules[at(choice)]) {
    double weight = rule.degree;
    for (const Set& set : rule.sets) {
      weight *= set.degree(source_[set.source]);
      if (weight == 0.0) break;
    }
    if (weight == 0.0) continue;
    double value = rule.offset;
    for (std::size_t i = 0; i < submodel.sources.size(); ++i)
      value += rule.coefficients[static_cast<Index>(i)] * source_[submodel.sources[i]];
    weights += weight;
    sum += weight * value;
  }
  return weights > kFaintest ? sum / weights : predictFar(output, choice, fired);
}

bool ChoiceModel::step(int choice, VectorRef disturbances, Eigen::Ref<Vector> state) {
  source_.head(n_x_) = state;
  source_.tail(disturbances.size()) = disturbances;
  bool fired = true;
  for (std::size_t i = 0; i < submodels_.size(); ++i)
    next_[static_cast<Index>(i)] = predict(i, choice, fired);
  if (memoryless_) {
    state = next_;
    return fired;
  }
  shiftState(next_, choices_.col(choice), disturbances, state);
  return fired;
}

}  // namespace fpc
