// Controllers that plan by simulation, on small processes: a linear one with two inputs and two
// outputs, and one whose gain changes with its level.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "control/fmbpc/law_fixture.hpp"
#include "control/mpc/nmpc.hpp"
#include "control/mpc/swarm_mpc.hpp"

namespace fpc::test {

/// y(k+1) = A y(k) + B u(k) + c.
inline TsModel twoByTwo(const Matrix& A, const Matrix& B, const Vector& c) {
  TsModel model;
  model.name = "two by two";
  model.sample_time_s = 1.0;
  model.outputs = {signal("y1"), signal("y2")};
  model.inputs = {signal("u1"), signal("u2")};
  model.submodels.resize(2);
  for (Eigen::Index i = 0; i < 2; ++i) {
    OutputModel& output = model.submodels[static_cast<std::size_t>(i)];
    output.regressors = {{SignalKind::kOutput, 0, 0},
                         {SignalKind::kOutput, 1, 0},
                         {SignalKind::kInput, 0, 0},
                         {SignalKind::kInput, 1, 0}};
    Rule rule;
    rule.coefficients = (Vector(4) << A(i, 0), A(i, 1), B(i, 0), B(i, 1)).finished();
    rule.offset = c[i];
    output.rules = {rule};
  }
  return model;
}

inline HorizonParams horizonParams(Eigen::Index n_y, Eigen::Index n_u, int steps, int moves,
                                   double move_weight) {
  HorizonParams params;
  params.horizon_steps = steps;
  params.move_steps = moves;
  params.weight_output = Vector::Ones(n_y);
  params.weight_move = Vector::Constant(n_u, move_weight);
  params.reference_pole = Vector::Zero(n_y);
  return params;
}

/// A tank: level + (input - root of the level) / 4, with a hidden leak. Not defined below zero.
class Tank final : public SampleModel {
 public:
  explicit Tank(double leak = 0.0) : leak_(leak) {}
  Eigen::Index stateSize() const override { return 1; }
  Eigen::Index outputState(Eigen::Index) const override { return 0; }
  void rest(VectorRef outputs, VectorRef, VectorRef, Eigen::Ref<Vector> state) override {
    state = outputs;
  }
  bool step(VectorRef input, VectorRef, Eigen::Ref<Vector> state) override {
    if (!(state[0] >= 0.0)) return false;
    state[0] += 0.25 * (input[0] - std::sqrt(state[0]) - leak_);
    return std::isfinite(state[0]);
  }

 private:
  double leak_;
};

inline PlantInfo tankInfo() {
  PlantInfo info;
  info.name = "tank";
  info.sample_time_s = 1.0;
  info.outputs = {signal("h")};
  info.inputs = {signal("u")};
  return info;
}

inline InputLimits tankLimits(double move = std::numeric_limits<double>::infinity()) {
  return {Vector::Zero(1), Vector::Constant(1, 3.0), Vector::Constant(1, move)};
}

inline NmpcParams tankParams(int steps = 8, int moves = 2, double move_weight = 0.01) {
  NmpcParams params;
  params.horizon = horizonParams(1, 1, steps, moves, move_weight);
  return params;
}

inline Measurement tankSample(std::uint32_t step, double level, double input) {
  Measurement m;
  m.header.step = step;
  m.outputs = Vector::Constant(1, level);
  m.disturbances = Vector(0);
  m.input_applied = Vector::Constant(1, input);
  return m;
}

/// Levels of a closed loop with a true tank; `visit` sees each answer.
template <typename Visit>
double runTank(Controller& law, Tank plant, double level, double setpoint, std::uint32_t samples,
               Visit visit, double input = 1.0) {
  SetpointSource source = setpointOf(tankInfo(), Vector::Constant(1, setpoint));
  ControllerOutput output;
  Vector state = Vector::Constant(1, level);
  law.reset(tankSample(0, level, input));
  for (std::uint32_t k = 0; k < samples; ++k) {
    source.advance(k);
    law.step(tankSample(k, state[0], input), source, output);
    visit(k, state[0], input, output);
    input = output.input[0];
    plant.step(output.input, Vector(0), state);
  }
  return state[0];
}

}  // namespace fpc::test
