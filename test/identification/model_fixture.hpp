// Models for tests: the shipped ones, random ones, and the plant they belong to.
#pragma once

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "config/model_file.hpp"
#include "paths.hpp"

namespace fpc::test {

inline TsModel shippedModel(const std::string& name) {
  return readModel(sourceDir() + "/config/model/" + name + ".yaml");
}

inline SignalInfo signal(const std::string& name, const std::string& unit = "1") {
  const double infinite = std::numeric_limits<double>::infinity();
  return {name, unit, -infinite, infinite};
}

inline std::vector<SignalInfo> numbered(const std::string& stem, int n) {
  std::vector<SignalInfo> signals;
  for (int i = 0; i < n; ++i) signals.push_back(signal(stem + std::to_string(i + 1)));
  return signals;
}

/// The plant of FM_1 and FM_2, as a controller sees it.
inline PlantInfo activatedSludgeInfo() {
  PlantInfo info;
  info.name = "activated_sludge";
  info.sample_time_s = 720.0;
  info.outputs = {signal("s", "mg/l"), signal("x", "mg/l")};
  info.inputs = {signal("q_r", "m3/h")};
  info.disturbances = {signal("q_i", "m3/h"), signal("s_i", "mg/l")};
  return info;
}

struct RandomModelShape {
  int n_y{2}, n_u{2}, n_d{1}, n_rules{3}, output_lags{2}, input_delay{1}, input_lags{2},
      disturbance_lags{2};
};

/// Every output depends on all outputs, inputs (from the delay on) and disturbances; stable unless
/// unlucky.
inline TsModel randomModel(std::mt19937_64& generator, const RandomModelShape& shape) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  TsModel model;
  model.name = "random";
  model.sample_time_s = 1.0;
  model.outputs = numbered("y", shape.n_y);
  model.inputs = numbered("u", shape.n_u);
  model.disturbances = numbered("d", shape.n_d);
  OutputModel blank;
  for (int i = 0; i < shape.n_y; ++i)
    for (int lag = 0; lag < shape.output_lags; ++lag)
      blank.regressors.push_back({SignalKind::kOutput, i, lag});
  for (int i = 0; i < shape.n_u; ++i)
    for (int lag = 0; lag < shape.input_lags; ++lag)
      blank.regressors.push_back({SignalKind::kInput, i, shape.input_delay + lag});
  for (int i = 0; i < shape.n_d; ++i)
    for (int lag = 0; lag < shape.disturbance_lags; ++lag)
      blank.regressors.push_back({SignalKind::kDisturbance, i, lag});
  blank.antecedents = blank.regressors;
  const double damping = 0.8 / (shape.n_y * shape.output_lags);
  for (int i = 0; i < shape.n_y; ++i) {
    OutputModel submodel = blank;
    for (int r = 0; r < shape.n_rules; ++r) {
      Rule rule;
      rule.coefficients.resize(static_cast<Eigen::Index>(blank.regressors.size()));
      for (std::size_t j = 0; j < blank.regressors.size(); ++j) {
        const bool output = blank.regressors[j].kind == SignalKind::kOutput;
        const bool own = output && blank.regressors[j].index == i && blank.regressors[j].lag == 0;
        rule.coefficients[static_cast<Eigen::Index>(j)] =
            (output ? damping : 1.0) * unit(generator) + (own ? 0.1 : 0.0);
        rule.antecedents.push_back(
            {MembershipShape::kGaussian, {3.0 * unit(generator), 2.0 + unit(generator)}});
      }
      rule.offset = unit(generator);
      submodel.rules.push_back(rule);
    }
    model.submodels.push_back(submodel);
  }
  return model;
}

inline PlantInfo infoOf(const TsModel& model) {
  PlantInfo info;
  info.name = model.name;
  info.sample_time_s = model.sample_time_s;
  info.outputs = model.outputs;
  info.inputs = model.inputs;
  info.disturbances = model.disturbances;
  return info;
}

/// One output y, y(k+1) = coefficients' regressors, one rule that fires everywhere within 1e3.
inline TsModel oneRule(std::vector<SignalInfo> inputs, std::vector<Regressor> regressors,
                       const Vector& coefficients) {
  TsModel model;
  model.name = "new";
  model.sample_time_s = 1.0;
  model.outputs = {signal("y")};
  model.inputs = std::move(inputs);
  OutputModel y;
  y.antecedents = {{SignalKind::kOutput, 0, 0}};
  y.regressors = std::move(regressors);
  y.rules = {{{{MembershipShape::kTriangular, {-1e3, 0.0, 1e3}}}, coefficients, 0.0, 0}};
  model.submodels = {y};
  return model;
}

inline Vector randomVector(std::mt19937_64& generator, Eigen::Index n, double size = 1.0) {
  std::uniform_real_distribution<double> unit(-size, size);
  return Vector::NullaryExpr(n, [&] { return unit(generator); });
}

}  // namespace fpc::test
