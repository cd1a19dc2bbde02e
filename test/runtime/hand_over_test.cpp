// From manual to automatic over every shipped loop: the plant gets in the first sample what the
// person left, and the moves after it grow no faster than the bias of a hand-over dies out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/factory.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace loop_hand_over_test {

constexpr std::uint32_t kManual = 8, kAuto = 28;  // samples

struct Loop {
  explicit Loop(const LoopFile& file)
      : plant(makeSimulation(file)), controller(makeControllerSession(file)) {
    if (controller.controller().needsModel()) controller.setModel(*IdentifierSession(file).start());
    if (file.has_clp) optimizer.emplace(makeOptimizerSession(file));
    plant.reset(1);
  }
  /// Answers the present sample; what the plant gets.
  const ControlAction& answer() {
    controller.receive(plant.measurement());
    const ControllerAnswer& answer = controller.answer();
    if (!optimizer) return answer.base;
    if (answer.has_prediction) optimizer->receive(answer.prediction);
    optimizer->receive(answer.base);
    return optimizer->action();
  }
  Simulation plant;
  ControllerSession controller;
  std::optional<OptimizerSession> optimizer;
};

/// Largest difference in shares of the range.
double distance(const InputLimits& limits, const Vector& a, const Vector& b) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double width = limits.upper[i] - limits.lower[i];
    largest = std::max(largest,
                       std::abs(a[i] - b[i]) / (std::isfinite(width) && width > 0.0 ? width : 1.0));
  }
  return largest;
}

/// A person drives the inputs towards `share` of their range for twenty samples.
double bumpOf(const LoopFile& file, double share) {
  const InputLimits& limits = file.simulation.actuator.limits;
  Loop loop(file);
  for (std::uint32_t k = 0;; ++k) {
    const Measurement now = loop.plant.measurement();
    if (k == kManual) {
      Vector left = now.input_applied;
      for (Eigen::Index i = 0; i < left.size(); ++i) {
        const double width = limits.upper[i] - limits.lower[i];
        left[i] = std::isfinite(width) ? limits.lower[i] + share * width : left[i] + share;
      }
      loop.controller.manual(true);
      loop.controller.controller().makeSendable(left);
      loop.controller.manualInput(left);
    }
    if (k == kAuto) loop.controller.manual(false);
    const ControlAction action = loop.answer();
    if (k == kAuto) return distance(limits, action.input, now.input_applied);
    loop.plant.advance(action.input);
  }
}

/// An experiment plays its own inputs, and between two positions of a valve there is nothing.
bool startsAsItIs(const LoopFile& file) {
  const InputLimits& limits = file.simulation.actuator.limits;
  const Loop loop(file);
  const Controller& law = loop.controller.controller();
  return law.followsSetpoint() && law.mayBeSent(0.3 * limits.lower + 0.7 * limits.upper);
}

TEST(HandOver, WhatThePlantGetsIsWhatThePersonLeft) {
  int looked = 0, with_clp = 0;
  for (const std::string& name : loopNames()) {
    const LoopFile file = readLoop(name, withoutRecords(name));
    if (file.external_plant || !startsAsItIs(file)) continue;
    for (const double share : {0.2, 0.7})
      EXPECT_LE(bumpOf(file, share), 1e-9) << name << " " << share;
    ++looked;
    with_clp += file.has_clp;
  }
  EXPECT_GT(looked, 150);
  EXPECT_GT(with_clp, 15);
}

}  // namespace loop_hand_over_test
}  // namespace fpc
