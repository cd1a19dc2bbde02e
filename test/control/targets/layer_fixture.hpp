// Small plants at rest for tests of the target layer.
#pragma once

#include <string>
#include <vector>

#include "control/targets/target_layer.hpp"

namespace fpc::targets_test {

inline SignalInfo signal(const std::string& name, double lower, double upper) {
  return {name, "-", lower, upper};
}

/// y(k+1) = a y(k) + b u(k) + offset for each output; b: n_y n_u.
inline TsModel linear(const std::vector<double>& a, const Matrix& b, double offset = 0.0) {
  TsModel model;
  model.name = "linear";
  model.sample_time_s = 60.0;
  for (Eigen::Index i = 0; i < b.rows(); ++i)
    model.outputs.push_back(signal("y" + std::to_string(i + 1), -100, 100));
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    model.inputs.push_back(signal("u" + std::to_string(j + 1), -10, 10));
  for (Eigen::Index i = 0; i < b.rows(); ++i) {
    OutputModel output;
    output.regressors.push_back({SignalKind::kOutput, static_cast<int>(i), 0});
    Rule rule;
    rule.coefficients = Vector(1 + b.cols());
    rule.coefficients[0] = a[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      output.regressors.push_back({SignalKind::kInput, static_cast<int>(j), 0});
      rule.coefficients[1 + j] = b(i, j);
    }
    rule.offset = offset;
    output.rules.push_back(rule);
    model.submodels.push_back(output);
  }
  return model;
}

inline PlantInfo plantOf(const TsModel& model) {
  PlantInfo plant;
  plant.name = "p";
  plant.sample_time_s = model.sample_time_s;
  plant.outputs = model.outputs;
  plant.inputs = model.inputs;
  return plant;
}

inline InputLimits limitsOf(const TsModel& model) {
  const auto n = static_cast<Eigen::Index>(model.inputs.size());
  return {Vector::Constant(n, -10.0), Vector::Constant(n, 10.0), Vector::Constant(n, kInfinity)};
}

inline TargetParams paramsOf(const TsModel& model) {
  TargetParams params;
  params.enabled = true;
  params.outputs.resize(model.outputs.size());
  params.inputs.resize(model.inputs.size());
  for (TargetInput& input : params.inputs) {
    input.lower = -10.0;
    input.upper = 10.0;
    input.rest = std::nan("");
  }
  const auto n_y = static_cast<Eigen::Index>(model.outputs.size());
  params.observer.noise_std = Vector::Zero(n_y);
  params.observer.disturbance_std = Vector::Ones(n_y);
  return params;
}

/// At rest with these.
inline Measurement measured(const Vector& y, const Vector& u, std::uint32_t step = 0) {
  Measurement m;
  m.header = {static_cast<std::int64_t>(step) * 60000000000, 1, step};
  m.outputs = y;
  m.disturbances = Vector();
  m.input_applied = u;
  return m;
}

}  // namespace fpc::targets_test
