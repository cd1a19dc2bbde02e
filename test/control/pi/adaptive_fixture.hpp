// A column of two inputs and outputs in deviations, closed by the adaptive loops.
#pragma once

#include <random>

#include "control/fmbpc/law_fixture.hpp"
#include "control/pi/adaptive_pi.hpp"
#include "model/column_model.hpp"

namespace fpc::test {

inline AdaptivePiParams adaptiveParams() {
  AdaptivePiParams params;
  params.loops[0] = {0, 0, 0.5, 1.5};
  params.loops[1] = {1, 1, -0.1, -0.4};
  params.model = columnMatrix();
  params.adaptation.enabled = true;
  return params;
}

inline PlantInfo columnInfo() {
  PlantInfo info;
  info.name = "column";
  info.sample_time_s = 60.0;
  info.outputs = {{"y_D", "mol%", -100.0, 100.0}, {"x_B", "mol%", -100.0, 100.0}};
  info.inputs = {{"L", "lb/min", -2.0, 2.0}, {"V", "lb/min", -2.0, 2.0}};
  return info;
}

class AdaptiveColumn {
 public:
  explicit AdaptiveColumn(const AdaptivePiParams& params, double limit = 2.0)
      : info(columnInfo()),
        law(params, wideLimits(2, limit), info),
        setpoint(setpointOf(info, Vector::Zero(2))),
        gains_(columnMatrix()) {
    for (const auto& row : columnMatrix())
      for (const auto& element : row) lags_.emplace_back(element, 1.0);
    now_.outputs = now_.input_applied = Vector::Zero(2);
    now_.disturbances.resize(0);
    law.reset(now_);
  }

  const Measurement& measure() {
    now_.header.step = step_;
    for (Eigen::Index i = 0; i < 2; ++i) {
      now_.outputs[i] = 0.0;
      for (std::size_t j = 0; j < 2; ++j) {
        const auto row = static_cast<std::size_t>(i);
        now_.outputs[i] += gains_[row][j].gain * lags_[2 * row + j].value();
      }
    }
    now_.outputs[0] += output_fault;
    return now_;
  }

  /// One sample with these setpoints.
  void step(double top, double bottom) {
    Command command{0, {"y_D", "x_B"}, {top, bottom}, CommandMode::kOverride};
    setpoint.command(command);
    measure();
    setpoint.advance(step_);
    ++step_;
    law.step(now_, setpoint, output);
    now_.input_applied = output.input;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        lags_[2 * i + j].advance(output.input[static_cast<Eigen::Index>(j)]);
  }

  /// Setpoints that change every 20 samples, seeded.
  void wander(int samples, double size = 0.5) {
    for (int k = 0; k < samples; ++k) {
      if (wandered_++ % 20 == 0) {
        top_ = generator_() & 1U ? size : -size;
        bottom_ = generator_() & 1U ? 0.5 * size : -0.5 * size;
      }
      step(top_, bottom_);
    }
  }

  void scaleGains(double up, double down) {
    gains_ = columnMatrix();
    gains_[0][0].gain *= up;
    gains_[0][1].gain *= down;
    gains_[1][0].gain *= up;
    gains_[1][1].gain *= down;
  }

  PlantInfo info;
  AdaptivePi law;
  SetpointSource setpoint;
  ControllerOutput output;
  double output_fault{};

 private:
  FopdtMatrix gains_;
  std::vector<LagResponse> lags_;
  Measurement now_;
  std::uint32_t step_{};
  int wandered_{};
  double top_{}, bottom_{};
  std::mt19937_64 generator_{23};
};

}  // namespace fpc::test
