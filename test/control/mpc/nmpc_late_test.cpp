// The nonlinear controller where outputs are measured late, on a tank whose level of d samples ago
// is shown: what a perfect model makes of it is known on paper.
#include <gtest/gtest.h>

#include <vector>

#include "control/mpc/fixture.hpp"

namespace fpc {
namespace control_horizon_nmpc_late_test {

/// The tank, whose level is seen `delay` samples late.
class LateTank final : public SampleModel {
 public:
  explicit LateTank(int delay) : delay_(delay) {}
  Eigen::Index stateSize() const override { return tank_.stateSize(); }
  Eigen::Index outputState(Eigen::Index output) const override { return tank_.outputState(output); }
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
            Eigen::Ref<Vector> state) override {
    tank_.rest(outputs, input, disturbances, state);
  }
  bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) override {
    return tank_.step(input, disturbances, state);
  }
  int delaySteps() const override { return delay_; }

 private:
  test::Tank tank_;
  int delay_;
};

struct Course {
  std::vector<double> level, shown, input, reference;  // of sample k
  std::vector<double> disturbance;                     // the signal before plan_cost
};

/// A run from rest at level 1 to setpoint 1.5; the law is told `delay` samples.
Course courseOf(const NmpcParams& params, int delay, std::size_t samples, bool observe = false,
                double leak = 0.0, double input_std = 0.0) {
  NmpcParams chosen = params;
  chosen.horizon.observe = observe;
  chosen.horizon.observer.noise_std = Vector::Constant(1, input_std > 0.0 ? 0.01 : 0.0);
  chosen.horizon.observer.disturbance_std = Vector::Ones(1);
  if (input_std > 0.0) chosen.horizon.observer.input_std = Vector::Constant(1, input_std);
  Nmpc law(chosen, test::tankLimits(), test::tankInfo(), std::make_unique<LateTank>(delay));
  test::Tank plant(leak);
  SetpointSource source = test::setpointOf(test::tankInfo(), Vector::Constant(1, 1.5));
  ControllerOutput output;
  Course course;
  const double rest = 1.0 + leak;  // holds level 1
  Vector state = Vector::Ones(1);
  double input = rest;
  for (std::size_t k = 0; k < samples; ++k) {
    const auto late = static_cast<std::size_t>(delay);
    course.level.push_back(state[0]);
    course.shown.push_back(k < late ? 1.0 : course.level[k - late]);
    const Measurement now =
        test::tankSample(static_cast<std::uint32_t>(k), course.shown.back(), input);
    if (k == 0) law.reset(now);
    source.advance(now.header.step);
    law.step(now, source, output);
    EXPECT_TRUE(output.ok) << k;
    input = output.input[0];
    course.input.push_back(input);
    course.reference.push_back(output.reference[0]);
    course.disturbance.push_back(law.signals().rbegin()[2].second);
    plant.step(output.input, Vector(0), state);
  }
  return course;
}

NmpcParams smoothParams(int steps, int moves, double move_weight) {
  NmpcParams params = test::tankParams(steps, moves, move_weight);
  params.horizon.reference_pole = Vector::Constant(1, 0.8);
  return params;
}

// A law that knows the delay and the process loses nothing by seeing late: the same inputs, and the
// same levels, which are shown later.
TEST(NmpcLate, OfAPerfectModelTheDelayChangesNothingButWhenItIsShown) {
  const Course at_once = courseOf(smoothParams(8, 2, 0.01), 0, 60);
  for (const bool observe : {false, true})
    for (const int delay : {1, 5}) {
      const Course late = courseOf(smoothParams(8, 2, 0.01), delay, 60, observe);
      for (std::size_t k = 0; k < 60; ++k) {
        EXPECT_NEAR(late.input[k], at_once.input[k], 1e-9) << delay << " " << k;
        EXPECT_NEAR(late.level[k], at_once.level[k], 1e-9) << delay << " " << k;
      }
    }
  EXPECT_GT(at_once.level[1], 1.01);  // it moves from the first sample on
}

// A plan of one sample meets y_r(k + 1 + lead) exactly: with the delay as lead what is shown is the
// reference from the first moment on at which an input can be seen.
TEST(NmpcLate, WithTheDelayAsLeadTheReferenceIsMetWhereItIsShown) {
  NmpcParams params = smoothParams(1, 1, 0.0);
  const Course plain = courseOf(params, 5, 40);
  params.horizon.reference_lead_steps = 5;
  const Course ahead = courseOf(params, 5, 40);
  for (std::size_t k = 0; k < 40; ++k) {
    EXPECT_NEAR(plain.level[k], plain.reference[k], 1e-6) << k;
    if (k > 5) EXPECT_NEAR(ahead.shown[k], ahead.reference[k], 1e-6) << k;
  }
}

// The leak is just an input that is missing.
TEST(NmpcLate, ALeakIsFoundOnTheInput) {
  for (const int delay : {0, 5}) {
    const Course course = courseOf(smoothParams(8, 2, 0.01), delay, 300, true, 0.4, 0.1);
    EXPECT_NEAR(course.level.back(), 1.5, 1e-8) << delay;
    EXPECT_NEAR(course.disturbance.back(), -0.4, 1e-6) << delay;
  }
}

TEST(NmpcLate, ALeakThatItDoesNotKnowLeavesNoOffset) {
  for (const bool observe : {false, true})
    for (const int delay : {1, 5}) {
      NmpcParams params = smoothParams(8, 2, 0.01);
      params.horizon.reference_lead_steps = delay;
      const Course course = courseOf(params, delay, 300, observe, 0.4);
      EXPECT_NEAR(course.level.back(), 1.5, 1e-8) << delay << " " << observe;
    }
}

}  // namespace control_horizon_nmpc_late_test
}  // namespace fpc
