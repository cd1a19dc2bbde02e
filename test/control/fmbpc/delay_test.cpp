// The law with a transport delay taken out of the model, and in the state space as printed.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/undelayed.hpp"

namespace fpc {
namespace control_fmbpc_delay_test {

Vector one(double value) { return Vector::Constant(1, value); }

FmbpcParams reactorParams(int delay_steps) {
  FmbpcParams params;
  params.coincidence_steps = 9;
  params.reference_pole = one(0.96);
  params.delay_steps = delay_steps;
  return params;
}

/// Inputs of a loop closed on a plant by the law with `model`, 0.1 -> 0.13 mol/l.
std::vector<double> inputsOf(const FmbpcParams& params, const TsModel& model,
                             test::ModelPlant plant, std::uint32_t samples,
                             std::vector<double>* outputs = nullptr) {
  const PlantInfo info = test::infoOf(model);
  SetpointSource setpoint = test::setpointOf(info, one(0.13));
  FmbpcLaw law(params, test::wideLimits(1), info);
  law.setModel(model);
  std::vector<double> inputs;
  test::start(law, plant, setpoint, samples, [&](const Measurement& m, const ControllerOutput& o) {
    inputs.push_back(o.input[0]);
    if (outputs) outputs->push_back(m.outputs[0]);
  });
  return inputs;
}

/// The input under which the undelayed model rests at y.
double restInput(const TsModel& early, double y) {
  LocalModel model(early);
  Vector state(model.stateSize());
  model.restState(one(y), one(0.0), Vector(0), state);
  model.blend(state, Vector(0));
  return (y - model.affine().A.row(0).dot(state) - model.affine().g[0]) / model.affine().B(0, 0);
}

TEST(FmbpcDelay, OnItsOwnModelTheDelayChangesNothingButTheTimeOfTheMeasurement) {
  const TsModel late = test::shippedModel("cstr_a");
  const TsModel early = withoutDelay(late, 5);
  const Vector u = one(restInput(early, 0.1));
  std::vector<double> y_late, y_early;
  const auto u_late =
      inputsOf(reactorParams(5), late, {late, one(0.1), u, Vector(0)}, 150, &y_late);
  const auto u_early =
      inputsOf(reactorParams(0), early, {early, one(0.1), u, Vector(0)}, 150, &y_early);
  for (std::size_t k = 0; k < 150; ++k) {
    EXPECT_NEAR(u_late[k], u_early[k], 1e-9 * std::abs(u_early[k])) << "sample " << k;
    if (k < 5) continue;
    EXPECT_NEAR(y_late[k], y_early[k - 5], 1e-9) << "sample " << k;
  }
}

FmbpcParams planningParams(int delay_steps, FmbpcRealisation realisation) {
  FmbpcParams params = reactorParams(delay_steps);
  params.law = FmbpcForm::kIterated;
  params.realisation = realisation;
  params.horizon_steps = 12;
  params.iterations = 30;
  params.weight_output = one(1.0);
  params.weight_move = one(0.0);
  params.observer.noise_std = params.observer.disturbance_std = one(0.001);
  return params;
}

// Of a plant that is its model, without limits or weights on moves, the plan meets every reference.
TEST(FmbpcDelay, APlanWithTheLeadOfTheDelayMeetsTheReferenceWhereItIsMeasured) {
  const TsModel model = test::shippedModel("cstr_a");
  const PlantInfo info = test::infoOf(model);
  const Vector u = one(restInput(withoutDelay(model, 5), 0.1));
  for (const auto realisation : {FmbpcRealisation::kParallel, FmbpcRealisation::kObserver}) {
    FmbpcParams params = planningParams(5, realisation);
    params.reference_lead_steps = 5;
    test::ModelPlant plant(model, one(0.1), u, Vector(0));
    SetpointSource setpoint = test::setpointOf(info, one(0.13));
    FmbpcLaw law(params, test::wideLimits(1), info);
    law.setModel(model);
    test::start(law, plant, setpoint, 80, [&](const Measurement& m, const ControllerOutput& o) {
      if (m.header.step <= 5) return;
      EXPECT_NEAR(m.outputs[0], o.reference[0], 1e-6) << m.header.step;
    });
  }
}

TEST(FmbpcDelay, APlanLeavesNoOffsetUnderAConstantDisturbance) {
  const TsModel model = test::shippedModel("cstr_a");
  TsModel process = model;
  for (Rule& rule : process.submodels[0].rules) rule.offset += 3e-4;
  std::vector<double> y;
  FmbpcParams params = planningParams(5, FmbpcRealisation::kObserver);
  params.weight_move = one(1e-8);
  inputsOf(params, model, {process, one(0.1), one(103.0), Vector(0)}, 600, &y);
  EXPECT_NEAR(y.back(), 0.13, 1e-6);
}

/// blazic2007, eq. 27, with states [y(k), y(k-1)], written out in plain loops.
class PlainLaw {
 public:
  PlainLaw(const TsModel& model, int horizon, int lead, double y, double u)
      : rules_(model.submodels[0].rules),
        horizon_(horizon),
        lead_(lead),
        early_{y, y},
        late_{y, y},
        past_(5, u) {}

  double step(double y, double y_r, double w, double applied, bool first) {
    if (!first) {
      advance(early_, applied);
      advance(late_, past_.front());
      past_.erase(past_.begin());
      past_.push_back(applied);
    }
    const Rule now = blended(early_[0]);
    double free[2] = {early_[0], early_[1]}, forced[2] = {0.0, 0.0};
    for (int i = 0; i < horizon_; ++i) {
      const double f = now.coefficients[0] * free[0] + now.coefficients[1] * free[1] + now.offset;
      const double g =
          now.coefficients[0] * forced[0] + now.coefficients[1] * forced[1] + now.coefficients[2];
      free[1] = free[0], free[0] = f;
      forced[1] = forced[0], forced[0] = g;
    }
    const double a = std::pow(0.96, horizon_ + lead_);
    return (a * y_r + (1.0 - a) * w - y + late_[0] - free[0]) / forced[0];
  }

 private:
  Rule blended(double y) const {
    Rule sum = rules_.front();
    sum.coefficients.setZero();
    sum.offset = 0.0;
    double total = 0.0;
    for (const Rule& rule : rules_) {
      const auto& set = rule.antecedents[0].parameters;
      const double weight = std::exp(-0.5 * std::pow((y - set[0]) / set[1], 2));
      sum.coefficients += weight * rule.coefficients;
      sum.offset += weight * rule.offset;
      total += weight;
    }
    sum.coefficients /= total;
    sum.offset /= total;
    return sum;
  }
  void advance(double (&state)[2], double u) const {
    const Rule rule = blended(state[0]);
    const double next = rule.coefficients[0] * state[0] + rule.coefficients[1] * state[1] +
                        rule.coefficients[2] * u + rule.offset;
    state[1] = state[0];
    state[0] = next;
  }

  std::vector<Rule> rules_;
  int horizon_, lead_;
  double early_[2], late_[2];
  std::vector<double> past_;
};

TEST(FmbpcDelay, IsTheLawOfThePaperOnInputOutputStates) {
  const TsModel model = test::shippedModel("cstr_a");
  TsModel process = model;
  for (Rule& rule : process.submodels[0].rules) rule.offset += 2e-4;
  for (const int lead : {0, 5}) {
    FmbpcParams params = reactorParams(5);
    params.reference_lead_steps = lead;
    const PlantInfo info = test::infoOf(model);
    test::ModelPlant plant(process, one(0.1), one(103.0), Vector(0));
    SetpointSource setpoint = test::setpointOf(info, one(0.13));
    FmbpcLaw law(params, test::wideLimits(1, 112.0), info);  // clips: the applied input counts
    law.setModel(model);
    PlainLaw plain(model, 9, lead, 0.1, 103.0);
    double y_r = 0.1;
    test::start(law, plant, setpoint, 100, [&](const Measurement& m, const ControllerOutput& o) {
      const double u = plain.step(m.outputs[0], y_r, 0.13, m.input_applied[0], m.header.step == 0);
      ASSERT_NEAR(o.prediction.input_base_unclipped[0], u, 1e-8) << "sample " << m.header.step;
      ASSERT_NEAR(o.reference[0], y_r, 1e-14);
      y_r = 0.96 * y_r + 0.04 * 0.13;
    });
  }
}

TEST(FmbpcDelay, LeavesNoOffsetUnderAConstantDisturbance) {
  const TsModel model = test::shippedModel("cstr_a");
  TsModel process = model;
  for (Rule& rule : process.submodels[0].rules) rule.offset += 3e-4;
  std::vector<double> y;
  inputsOf(reactorParams(5), model, {process, one(0.1), one(103.0), Vector(0)}, 900, &y);
  EXPECT_NEAR(y.back(), 0.13, 1e-6);
}

TEST(FmbpcLiteral, StatesAsPrintedAnswerOneSampleLaterSoAHorizonOfOneHasNoEffect) {
  const TsModel model = test::shippedModel("cstr_b");
  const PlantInfo info = test::infoOf(model);
  for (const int horizon : {1, 2}) {
    FmbpcParams params = reactorParams(5);
    params.realisation = FmbpcRealisation::kLiteral;
    params.coincidence_steps = horizon;
    test::ModelPlant plant(model, one(0.1), one(103.0), Vector(0));
    SetpointSource setpoint = test::setpointOf(info, one(0.13));
    FmbpcLaw law(params, test::wideLimits(1), info);
    law.setModel(model);
    ControllerOutput output;
    law.reset(plant.measure(0));
    setpoint.advance(0);
    law.step(plant.measure(0), setpoint, output);
    EXPECT_EQ(output.ok, horizon == 2);
    if (!output.ok) continue;
    const auto& p = output.prediction;
    EXPECT_EQ(p.state.size(), 2);
    EXPECT_EQ(p.C(0, 1), 0.0);
    EXPECT_NEAR(p.input_base_unclipped[0], (p.feedforward.col(0) - p.K * p.state)[0], 1e-9);
  }
}

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(FmbpcDelay, WhatDoesNotFitIsRefusedByName) {
  const TsModel model = test::shippedModel("cstr_a");
  const PlantInfo info = test::infoOf(model);
  const auto with = [&](const std::function<void(FmbpcParams&)>& change) {
    return errorOf([&] {
      FmbpcParams params = reactorParams(5);
      change(params);
      FmbpcLaw(params, test::wideLimits(1), info).setModel(model);
    });
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_NE(with([](auto& p) { p.delay_steps = 6; }).find("from 0 to the delay"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) { p.delay_steps = -1; }).find("controller.delay_steps"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) {
              p.realisation = FmbpcRealisation::kRealigned;
            }).find("controller.delay_steps"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) { p.reference_lead_steps = -1; }).find("reference_lead_steps"),
            std::string::npos);
  EXPECT_NE(with([](auto& p) {
              p.realisation = FmbpcRealisation::kLiteral;
              p.delay_steps = 4;
            }).find("controller.realisation"),
            std::string::npos);
}

TEST(Undelayed, ShortensEveryLagOfTheInputsAndNoneOfTheOutputs) {
  const TsModel model = test::shippedModel("cstr_a");
  EXPECT_EQ(transportDelay(model), 5);
  EXPECT_EQ(transportDelay(test::shippedModel("fm_1")), 0);
  const TsModel early = withoutDelay(model, 3);
  EXPECT_EQ(transportDelay(early), 2);
  EXPECT_EQ(early.maxLag(SignalKind::kOutput, 0), 1);
  EXPECT_THROW(withoutDelay(model, 6), InputError);
}

}  // namespace control_fmbpc_delay_test
}  // namespace fpc
