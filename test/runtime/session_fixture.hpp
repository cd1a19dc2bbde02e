// A plant with two outputs and one input, its samples, and a controller that remembers what was
// asked of it: for tests of the rules of the exchange.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "runtime/session.hpp"

namespace fpc::test_session {

constexpr std::int64_t kStart = 1234500000000;  // t0 is not 1 s
constexpr std::int64_t kSample = 720000000000;

inline Vector of(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

inline PlantInfo plant() {
  PlantInfo info;
  info.header.time_ns = kStart;
  info.sample_time_s = 720.0;
  info.outputs = {{"s", "mg/l", 0, 1000}, {"x", "mg/l", 0, 5000}};
  info.inputs = {{"q_r", "m3/h", 0, 1600}};
  info.disturbances = {{"q_i", "m3/h", 0, 3000}};
  return info;
}

inline InputLimits limits(double move = kInfinity) { return {of({0.0}), of({1600.0}), of({move})}; }

inline SetpointParams setpoints() {
  SetpointParams p;
  p.initial = of({55.0, 2000.0});
  return p;
}

inline Measurement sample(std::uint32_t step, std::uint64_t run_id = 1, double applied = 570.0) {
  const std::uint64_t after_start = std::uint64_t{step} * kSample;  // a forged step may wrap
  return {{kStart + static_cast<std::int64_t>(after_start), run_id, step},
          of({56.0, 1990.0}),
          of({1300.0}),
          of({applied}),
          false};
}

// Remembers what was asked of it; answers input_applied + 1 and a prediction.
struct FakeLaw : Controller {
  void reset(const Measurement& start) override { resets.push_back(start.header.step); }
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override {
    ASSERT_TRUE(now.outputs.allFinite() && now.disturbances.allFinite() &&
                now.input_applied.allFinite());
    steps.push_back(now.header.step);
    seen_setpoint = setpoint.present();
    output.input = now.input_applied.array() + 1.0;
    output.source = ActionSource::kBase;
    output.reference = 0.5 * (now.outputs + setpoint.present());
    output.predictive = true;
    output.prediction.state = now.outputs;
    output.ok = true;
    if (spoil) spoil(output);
  }
  void lookOn(const Measurement& now) override {
    ASSERT_TRUE(now.outputs.allFinite() && now.disturbances.allFinite() &&
                now.input_applied.allFinite());
    looks.push_back(now.header.step);
  }
  bool needsModel() const override { return needs_model; }
  void setModel(const TsModel& model) override {
    if (model.name == "bad") throw InputError("model.name: expected a good one");
    models.push_back(model.name);
  }

  std::vector<std::uint32_t> resets, steps, looks;
  std::vector<std::string> models;
  Vector seen_setpoint;
  bool needs_model{false};
  std::function<void(ControllerOutput&)> spoil;
};

class SessionFixture : public testing::Test {
 protected:
  void make(const InputLimits& input_limits = limits(), const SetpointParams& p = setpoints()) {
    auto owned = std::make_unique<FakeLaw>();
    law = owned.get();
    session = std::make_unique<ControllerSession>(std::move(owned), p, input_limits, of({570.0}),
                                                  plant());
  }
  void SetUp() override { make(); }
  double input() const { return session->answer().base.input[0]; }
  ActionSource source() const { return session->answer().base.source; }

  FakeLaw* law{};
  std::unique_ptr<ControllerSession> session;
};

using Steps = std::vector<std::uint32_t>;

/// q_r was between 400 and 1000 in the data, s between 50 and 60, x between 1800 and 2200.
inline TsModel boxModel() {
  TsModel m;
  m.name = "box";
  m.sample_time_s = 720.0;
  m.outputs = {{"s", "mg/l", 50, 60}, {"x", "mg/l", 1800, 2200}};
  m.inputs = {{"q_r", "m3/h", 400, 1000}};
  m.disturbances = {{"q_i", "m3/h", 1000, 1600}};
  OutputModel submodel;
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  Rule rule;
  rule.coefficients = of({0.5, 0.5});
  submodel.rules = {rule};
  m.submodels = {submodel, submodel};
  return m;
}

}  // namespace fpc::test_session
