// Models with one premise partition, and the fuzzy optimal law on them.
#pragma once

#include <random>

#include "control/fmbpc/law_fixture.hpp"
#include "control/fuzzy_lq/law.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc::test {

inline FuzzyOptimalParams optimalParams(Eigen::Index n_y, Eigen::Index n_u, int horizon, int moves,
                                        double move_weight) {
  FuzzyOptimalParams p;
  p.tuning.horizon_steps = horizon;
  p.tuning.move_steps = moves;
  p.tuning.weight = {Vector::Ones(n_y), Vector::Constant(n_u, move_weight), Vector::Zero(n_u)};
  p.tuning.input_target = Vector::Zero(n_u);
  p.reference_pole = Vector::Zero(n_y);
  return p;
}

/// randomModel() with the sets of the first output in all outputs.
inline TsModel sharedRandomModel(std::mt19937_64& generator, const RandomModelShape& shape) {
  TsModel model = randomModel(generator, shape);
  for (auto& submodel : model.submodels)
    for (std::size_t r = 0; r < submodel.rules.size(); ++r)
      submodel.rules[r].antecedents = model.submodels[0].rules[r].antecedents;
  return model;
}

/// n outputs and inputs; in each of three rules, told apart by y1, output i is mainly moved by
/// input i, with two lags of itself and poles between 0.4 and 0.8.
inline TsModel dominantModel(std::mt19937_64& generator, int n) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  TsModel model;
  model.name = "dominant";
  model.sample_time_s = 1.0;
  model.outputs = numbered("y", n);
  model.inputs = numbered("u", n);
  model.disturbances = numbered("d", 1);
  for (int i = 0; i < n; ++i) {
    OutputModel submodel;
    submodel.antecedents = {{SignalKind::kOutput, 0, 0}};
    submodel.regressors = {{SignalKind::kOutput, i, 0}, {SignalKind::kOutput, i, 1}};
    for (int j = 0; j < n; ++j) submodel.regressors.push_back({SignalKind::kInput, j, 0});
    submodel.regressors.push_back({SignalKind::kDisturbance, 0, 1});
    for (int g = 0; g < 3; ++g) {
      const double p = 0.6 + 0.2 * unit(generator), q = 0.2 + 0.1 * unit(generator);
      Rule rule;
      rule.coefficients = Vector::Zero(3 + n);
      rule.coefficients.head(2) << p + q, -p * q;
      for (int j = 0; j < n; ++j)
        rule.coefficients[2 + j] = i == j ? 0.3 + 0.1 * unit(generator) : 0.05 * unit(generator);
      rule.coefficients[2 + n] = 0.2 * unit(generator);
      rule.offset = 0.2 * unit(generator);
      rule.antecedents = {{MembershipShape::kGaussian, {g - 1.0, 0.6}}};
      submodel.rules.push_back(rule);
    }
    model.submodels.push_back(submodel);
  }
  return model;
}

/// The same with every coefficient off by up to `share`, and other offsets.
inline TsModel mistaken(TsModel model, std::mt19937_64& generator, double share) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (auto& submodel : model.submodels)
    for (auto& rule : submodel.rules) {
      for (double& c : rule.coefficients) c *= 1.0 + share * unit(generator);
      rule.offset += share * unit(generator);
    }
  return model;
}

/// The example of two inputs as it answers to past outputs and inputs: exact.
inline TsModel linearExampleModel() {
  const double pole[2][2] = {{0.9401, 0.9524}, {0.9083, 0.9306}};
  const double gain[2][2] = {{-0.7664, 0.9}, {-0.6055, 1.3472}};
  TsModel model;
  model.name = "linear 2x2";
  model.sample_time_s = 1.0;
  model.outputs = numbered("y", 2);
  model.inputs = numbered("u", 2);
  model.submodels.resize(2);
  for (int i = 0; i < 2; ++i) {
    model.submodels[static_cast<std::size_t>(i)].regressors = {
        {SignalKind::kOutput, i, 0}, {SignalKind::kOutput, i, 1}, {SignalKind::kInput, 0, 0},
        {SignalKind::kInput, 0, 1},  {SignalKind::kInput, 1, 0},  {SignalKind::kInput, 1, 1}};
    const double a = pole[i][0], b = pole[i][1], p = gain[i][0], q = gain[i][1];
    Rule rule;
    rule.coefficients = (Vector(6) << a + b, -a * b, p, -p * b, q, -q * a).finished();
    model.submodels[static_cast<std::size_t>(i)].rules = {rule};
  }
  return model;
}

}  // namespace fpc::test
