// A closed loop in a few lines: a plant made of a fuzzy model, a law, a setpoint.
#pragma once

#include <functional>
#include <utility>

#include "control/fmbpc/law.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/model/local_model.hpp"
#include "identification/model_fixture.hpp"

namespace fpc::test {

inline Vector pair(double a, double b) {
  Vector v(2);
  v << a, b;
  return v;
}

inline InputLimits wideLimits(Eigen::Index n_u, double size = 1e9) {
  const double infinite = std::numeric_limits<double>::infinity();
  return {Vector::Constant(n_u, -size), Vector::Constant(n_u, size),
          Vector::Constant(n_u, infinite)};
}

inline SetpointSource setpointOf(const PlantInfo& info, const Vector& initial,
                                 std::vector<SetpointStep> schedule = {}) {
  SetpointParams params;
  params.initial = initial;
  params.schedule = std::move(schedule);
  std::vector<std::string> names;
  for (const auto& output : info.outputs) names.push_back(output.name);
  return {params, names, SampleClock(info.sample_time_s, 1.0)};
}

/// The paper's configuration of case 1.
inline FmbpcParams publishedParams() {
  FmbpcParams params;
  params.reference_pole = (Vector(2) << 0.76, 0.96).finished();
  return params;
}

inline FmbpcParams generalParams(Eigen::Index n_y, Eigen::Index n_u, int horizon, double pole,
                                 double move_weight) {
  FmbpcParams params;
  params.law = FmbpcForm::kGeneral;
  params.coincidence_steps = horizon;
  params.reference_pole = Vector::Constant(n_y, pole);
  params.weight_output = Vector::Ones(n_y);
  params.weight_move = Vector::Constant(n_u, move_weight);
  return params;
}

/// A plant that is itself a Takagi-Sugeno model, with sensors that are off by a constant.
class ModelPlant {
 public:
  ModelPlant(TsModel model, const Vector& outputs, const Vector& input, Vector disturbance)
      : d(std::move(disturbance)),
        output_bias(Vector::Zero(outputs.size())),
        local_(std::move(model)),
        u_(input) {
    state_.resize(local_.stateSize());
    local_.restState(outputs, input, d, state_);
  }
  Measurement measure(std::uint32_t step) const {
    Measurement m;
    m.header.step = step;
    m.outputs = local_.affine().C * state_ + output_bias;
    m.disturbances = d;
    m.input_applied = u_;
    return m;
  }
  void advance(const Vector& input) {
    u_ = input;
    local_.blend(state_, d);
    state_ = (local_.affine().A * state_ + local_.affine().B * input + local_.affine().g).eval();
  }

  Vector d, output_bias;

 private:
  LocalModel local_;
  Vector state_, u_;
};

using Visitor = std::function<void(const Measurement&, const ControllerOutput&)>;

/// Samples [from, to) of a closed loop; the law must have been reset.
inline void run(Controller& law, ModelPlant& plant, SetpointSource& setpoint, std::uint32_t from,
                std::uint32_t to, const Visitor& visit = {}) {
  ControllerOutput output;
  for (std::uint32_t k = from; k < to; ++k) {
    const Measurement now = plant.measure(k);
    setpoint.advance(k);
    law.step(now, setpoint, output);
    if (visit) visit(now, output);
    plant.advance(output.input);
  }
}

/// Reset at sample 0, then samples [0, to).
inline void start(Controller& law, ModelPlant& plant, SetpointSource& setpoint, std::uint32_t to,
                  const Visitor& visit = {}) {
  law.reset(plant.measure(0));
  run(law, plant, setpoint, 0, to, visit);
}

/// One output, one input: y+ = a y + b u + c.
inline TsModel firstOrder(double a, double b, double c, int delay = 0) {
  TsModel model;
  model.name = "first order";
  model.sample_time_s = 1.0;
  model.outputs = {signal("y")};
  model.inputs = {signal("u")};
  model.submodels.resize(1);
  model.submodels[0].regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, delay}};
  Rule rule;
  rule.coefficients = (Vector(2) << a, b).finished();
  rule.offset = c;
  model.submodels[0].rules = {rule};
  return model;
}

}  // namespace fpc::test
