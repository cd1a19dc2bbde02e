// Problems of any size for growth curves: a chain of tanks, fuzzy models with as many outputs and
// rules as asked, predictions whose limits are active.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "control/clp/closed_loop_paradigm.hpp"
#include "control/fmbpc/law.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/plant/plant.hpp"
#include "identification/model_fixture.hpp"

namespace fpc::bench {

/// n tanks in a row, each drained into the next one by its level: A dx_i/dt = q_(i-1) - q_i,
/// q_i = c sqrt(x_i), q_0 the input. At rest with an inflow of 1 all levels are 1.
class TankChain final : public Plant {
 public:
  explicit TankChain(int tanks) {
    description_.name = "tank_chain";
    for (int i = 0; i < tanks; ++i)
      description_.states.push_back({"x" + std::to_string(i), "m", 1.0, 0.0, 1e3});
    description_.inputs = {{"q", "m3/s", 1.0, 0.0, 10.0}};
  }
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef, Eigen::Ref<Vector> dxdt) const override {
    double inflow = u[0];
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double outflow = std::sqrt(std::max(x[i], 0.0));
      dxdt[i] = inflow - outflow;
      inflow = outflow;
    }
  }

 private:
  PlantDescription description_;
};

/// y_i(k+1) = a y_i + b y_(i-1) + c u_i, a blended over `rules` sets on y_i.
inline TsModel neighbourModel(int outputs, int rules) {
  TsModel model;
  model.name = "neighbours";
  model.sample_time_s = 1.0;
  for (int i = 0; i < outputs; ++i) {
    model.outputs.push_back({"y" + std::to_string(i), "-", -10.0, 10.0});
    model.inputs.push_back({"u" + std::to_string(i), "-", -10.0, 10.0});
    OutputModel submodel;
    submodel.antecedents = {{SignalKind::kOutput, i, 0}};
    submodel.regressors = {{SignalKind::kOutput, i, 0}, {SignalKind::kInput, i, 0}};
    if (i > 0) submodel.regressors.push_back({SignalKind::kOutput, i - 1, 0});
    const auto size = static_cast<Eigen::Index>(submodel.regressors.size());
    for (int r = 0; r < rules; ++r) {
      const double at = rules == 1 ? 0.0 : -2.0 + 4.0 * r / (rules - 1);
      Rule rule;
      rule.antecedents = {{MembershipShape::kGaussian, {at, 4.0 / rules}}};
      rule.coefficients = Vector::Constant(size, 0.05);
      rule.coefficients[0] = 0.8 + 0.05 * at;
      rule.coefficients[1] = 0.3;
      submodel.rules.push_back(rule);
    }
    model.submodels.push_back(submodel);
  }
  return model;
}

/// The law on a neighbourModel(), asked again and again at two setpoints in turn.
class LawCase {
 public:
  LawCase(int outputs, int rules, int horizon)
      : model_(neighbourModel(outputs, rules)),
        setpoint_(setpointParams(outputs), namesOf(model_.outputs), SampleClock(1.0, 1.0)),
        law_(paramsOf(outputs, horizon), limitsOf(outputs), test::infoOf(model_)) {
    now_.outputs = Vector::Zero(outputs);
    now_.disturbances = Vector::Zero(0);
    now_.input_applied = Vector::Zero(outputs);
    law_.setModel(model_);
    law_.reset(now_);
  }

  void step() {
    setpoint_.advance(now_.header.step);
    law_.step(now_, setpoint_, output_);
    now_.input_applied = output_.input;
    now_.outputs.setConstant(now_.header.step % 2 == 0 ? 0.1 : -0.1);
    ++now_.header.step;
  }

 private:
  static SetpointParams setpointParams(int outputs) {
    SetpointParams params;
    params.initial = Vector::Constant(outputs, 0.5);
    return params;
  }
  static FmbpcParams paramsOf(int outputs, int horizon) {
    FmbpcParams params;
    params.law = FmbpcForm::kGeneral;
    params.coincidence_steps = horizon;
    params.reference_pole = Vector::Constant(outputs, 0.7);
    params.weight_output = Vector::Ones(outputs);
    params.weight_move = Vector::Constant(outputs, 0.1);
    return params;
  }
  static InputLimits limitsOf(int inputs) {
    return {Vector::Constant(inputs, -10.0), Vector::Constant(inputs, 10.0),
            Vector::Constant(inputs, 5.0)};
  }

  TsModel model_;
  SetpointSource setpoint_;
  FmbpcLaw law_;
  Measurement now_;
  ControllerOutput output_;
};

/// CLP with `inputs` inputs over `steps` samples, bounds and move limits; a law that aims too high
/// and too low in turn, so that every step solves a QP with active limits.
class ClpCase {
 public:
  ClpCase(int inputs, int steps)
      : inputs_(inputs),
        clp_(paramsOf(steps),
             {Vector::Constant(inputs, -1.0), Vector::Constant(inputs, 1.0),
              Vector::Constant(inputs, 0.4)},
             inputs, inputs, inputs) {
    now_.A = 0.9 * Matrix::Identity(inputs, inputs);
    for (int i = 1; i < inputs; ++i) now_.A(i, i - 1) = 0.05;
    now_.B = 0.3 * Matrix::Identity(inputs, inputs);
    now_.C = Matrix::Identity(inputs, inputs);
    now_.K = 0.8 * Matrix::Identity(inputs, inputs);
    now_.state = Vector::Zero(inputs);
    now_.offset_state = now_.offset_output = now_.setpoint = now_.input_previous = now_.state;
    now_.feedforward.setZero(inputs, steps);
    now_.reference.setZero(inputs, steps);
  }

  void step(bool warm) {
    const double aim = k_++ / 7 % 2 == 0 ? 1.5 : -1.5;
    for (int i = 0; i < inputs_; ++i) now_.feedforward.row(i).setConstant(i % 2 == 0 ? aim : -aim);
    now_.input_base_unclipped = now_.feedforward.col(0) - now_.K * now_.state;
    if (!warm) clp_.reset();
    clp_.step(now_, action_, report_);
    now_.state = (now_.A * now_.state + now_.B * action_.input).eval();
    now_.input_previous = action_.input;
    iterations += report_.iterations;
    unsolved += report_.status != SolveStatus::kSolved && report_.status != SolveStatus::kNotRun;
  }
  double iterations{};
  int unsolved{};
  long steps() const { return k_; }

 private:
  static ClpParams paramsOf(int steps) {
    ClpParams params;
    params.perturbation_steps = steps;
    return params;
  }
  int inputs_;
  ClosedLoopParadigm clp_;
  PredictiveAction now_;
  ControlAction action_;
  SolverReport report_;
  long k_{};
};

}  // namespace fpc::bench
