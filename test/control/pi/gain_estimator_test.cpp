#include "control/pi/gain_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "model/column_model.hpp"

namespace fpc {
namespace control_pi_gain_estimator_test {

/// The sum of two elements under inputs that change every 10 samples.
struct Process {
  explicit Process(std::array<Fopdt, 2> row) : elements(row) {
    for (const auto& e : row) lags.emplace_back(e, 1.0);
  }
  double advance() {
    if (k++ % 10 == 0)
      for (double& u : inputs) u = excite && (generator() & 1U) ? 0.05 : -0.05;
    double y = 0.0;
    for (std::size_t j = 0; j < 2; ++j) y += elements[j].gain * lags[j].advance(inputs[j]);
    return y;
  }
  std::array<Fopdt, 2> elements;
  std::vector<LagResponse> lags;
  std::array<double, 2> inputs{};
  std::mt19937_64 generator{17};
  int k{};
  bool excite{true};
};

struct Case {
  GainEstimatorParams params;
  double noise{}, step_at_200{};  ///< an unmeasured feed
  int samples{550};
};

/// Relative errors of both gains when the true ones are 20 % off the nominal ones.
std::array<double, 2> errors(const Case& c) {
  const std::array<Fopdt, 2> nominal = test::columnMatrix()[0];
  std::array<Fopdt, 2> truth = nominal;
  truth[0].gain *= 1.2;
  truth[1].gain *= 0.8;
  Process process(truth);
  GainEstimator estimator(nominal, 1.0, c.params);
  estimator.rest(0.0, 0.0);
  std::mt19937_64 generator(9);
  std::normal_distribution<double> normal;
  for (int k = 0; k < c.samples; ++k) {
    const double y =
        process.advance() + c.noise * normal(generator) + (k >= 200 ? c.step_at_200 : 0.0);
    estimator.advance(process.inputs[0], process.inputs[1]);
    estimator.update(y);
  }
  return {std::abs(estimator.gain(0) / truth[0].gain - 1.0),
          std::abs(estimator.gain(1) / truth[1].gain - 1.0)};
}

TEST(GainEstimator, FindsBothGainsFromTheMeasuredSum) {
  const auto [first, second] = errors({});
  EXPECT_LT(first, 1e-6);
  EXPECT_LT(second, 1e-6);
}

TEST(GainEstimator, IsNotBiasedByNoiseOfTheOutput) {
  Case c;
  c.params.forgetting = 1.0;
  c.noise = 0.05;
  c.samples = 4000;
  const auto [first, second] = errors(c);
  EXPECT_LT(first, 0.02);
  EXPECT_LT(second, 0.02);
}

TEST(GainEstimator, NeedsItsBiasColumnAgainstAnUnmeasuredFeed) {
  Case c;
  c.step_at_200 = 0.76;  // F = 0.2 times 3.8
  const auto with = errors(c);
  c.params.bias = false;
  const auto without = errors(c);
  std::cout << "unmeasured feed: errors of the gains [%] with bias column " << 100 * with[0] << ", "
            << 100 * with[1] << ", without " << 100 * without[0] << ", " << 100 * without[1]
            << "\n";
  EXPECT_LT(with[0], 0.01);
  EXPECT_LT(with[1], 0.01);
  EXPECT_GT(std::max(without[0], without[1]), 0.1);
}

TEST(GainEstimator, LearnsNothingWithoutMovementAndThenStaysWhereItIs) {
  GainEstimatorParams params;
  params.excitation_lower = 0.01;
  const auto row = test::columnMatrix()[0];
  GainEstimator estimator(row, 1.0, params);
  estimator.rest(0.1, -0.1);
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 1500; ++k) {
    estimator.advance(0.1, -0.1);
    EXPECT_FALSE(estimator.update(3.17 + 0.1 * normal(generator)));
  }
  EXPECT_EQ(estimator.gain(0), row[0].gain);
  EXPECT_EQ(estimator.gain(1), row[1].gain);
}

TEST(GainEstimator, KnowsHowLittleItKnows) {
  const auto row = test::columnMatrix()[0];
  Process process(row);
  GainEstimator estimator(row, 1.0, {});
  estimator.rest(0.0, 0.0);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  double early = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double y = process.advance() + 0.05 * normal(generator);
    estimator.advance(process.inputs[0], process.inputs[1]);
    estimator.update(y);
    if (k == 20) early = estimator.deviation(0);
  }
  EXPECT_LT(estimator.deviation(0), early);
  EXPECT_LT(std::abs(estimator.gain(0) / 12.8 - 1.0), 4.0 * estimator.deviation(0));
}

TEST(GainEstimator, SkipsWhatIsNotFiniteAndRefusesBadParameters) {
  GainEstimator estimator(test::columnMatrix()[0], 1.0, {});
  estimator.advance(0.1, 0.0);
  EXPECT_FALSE(estimator.update(std::nan("")));
  EXPECT_EQ(estimator.gain(0), 12.8);
  GainEstimatorParams params;
  params.forgetting = 1.1;
  EXPECT_THROW(GainEstimator(test::columnMatrix()[0], 1.0, params), InputError);
}

}  // namespace control_pi_gain_estimator_test
}  // namespace fpc
