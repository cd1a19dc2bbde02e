// The fuzzy optimal law reaches its setpoints although plant and model differ: because the
// disturbance estimate of every rule is inside its recursion, and only then.
#include <gtest/gtest.h>

#include "control/fuzzy_lq/fixture.hpp"

namespace fpc {
namespace control_optimal_offset_test {

/// Inputs reach the plant with an error, outputs are measured with one.
double finalError(const FuzzyOptimalParams& params, const TsModel& model, const TsModel& truth,
                  const Vector& target, double input_error, double output_error) {
  const PlantInfo info = test::infoOf(truth);
  const auto n = static_cast<Eigen::Index>(info.inputs.size());
  const Vector off = Vector::Constant(n, input_error);
  test::ModelPlant plant(truth, Vector::Zero(n), Vector::Zero(n), Vector::Constant(1, 0.3));
  plant.output_bias.setConstant(output_error);
  SetpointSource setpoint = test::setpointOf(info, target);
  FuzzyOptimalLaw law(params, test::wideLimits(n), info);
  law.setModel(model);
  law.reset(plant.measure(0));
  ControllerOutput output;
  Vector sent = Vector::Zero(n);
  double error = 0.0;
  for (std::uint32_t k = 0; k < 1500; ++k) {
    Measurement now = plant.measure(k);
    now.input_applied = sent;
    setpoint.advance(k);
    law.step(now, setpoint, output);
    EXPECT_TRUE(output.ok);
    error = (now.outputs - target).cwiseAbs().maxCoeff();
    sent = output.input;
    plant.advance(sent + off);
  }
  return error;
}

struct Mismatch {
  const char* name;
  double parameters, input, output;
};

TEST(FuzzyOptimalOffset, NoneUnderInputOutputAndParameterMismatchForAnyHorizon) {
  const Mismatch mismatches[] = {{"input", 0.0, 0.4, 0.0},
                                 {"output", 0.0, 0.0, 0.3},
                                 {"parameters", 0.15, 0.0, 0.0},
                                 {"all", 0.15, 0.4, 0.3}};
  const int horizons[][2] = {{1, 1}, {5, 1}, {12, 3}};
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const Mismatch& m : mismatches)
      for (const auto& [P, M] : horizons) {
        std::mt19937_64 generator(seed);
        const int n = 1 + static_cast<int>(seed % 2);
        const TsModel truth = test::dominantModel(generator, n);
        const TsModel model = test::mistaken(truth, generator, m.parameters);
        const Vector target = test::randomVector(generator, n, 0.8);
        EXPECT_LT(finalError(test::optimalParams(n, n, P, M, 0.1), model, truth, target, m.input,
                             m.output),
                  1e-8)
            << "seed " << seed << ", mismatch of " << m.name << ", P " << P << ", M " << M;
      }
}

TEST(FuzzyOptimalOffset, OutsideTheRecursionOneStepIsFreeOfItAndLongerHorizonsAreNot) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 generator(seed);
    const TsModel truth = test::dominantModel(generator, 2);
    const TsModel model = test::mistaken(truth, generator, 0.15);
    const Vector target = test::randomVector(generator, 2, 0.8);
    const auto error = [&](int P, FuzzyOptimalDisturbance where) {
      FuzzyOptimalParams params = test::optimalParams(2, 2, P, 1, 0.1);
      params.disturbance = where;
      return finalError(params, model, truth, target, 0.4, 0.3);
    };
    EXPECT_LT(error(1, FuzzyOptimalDisturbance::kOutside), 1e-8) << "seed " << seed;
    EXPECT_GT(error(5, FuzzyOptimalDisturbance::kOutside), 1e-2) << "seed " << seed;
    EXPECT_LT(error(5, FuzzyOptimalDisturbance::kInside), 1e-8) << "seed " << seed;
    EXPECT_GT(error(1, FuzzyOptimalDisturbance::kNone), 1e-2) << "seed " << seed;
  }
}

TEST(FuzzyOptimalOffset, AWeightTowardsTheWrongInputLeavesOne) {
  std::mt19937_64 generator(5);
  const TsModel truth = test::dominantModel(generator, 2);
  FuzzyOptimalParams params = test::optimalParams(2, 2, 5, 1, 0.1);
  params.tuning.weight.input.setConstant(0.1);
  EXPECT_GT(finalError(params, truth, truth, test::pair(0.8, -0.8), 0.0, 0.0), 1e-3);
}

}  // namespace control_optimal_offset_test
}  // namespace fpc
