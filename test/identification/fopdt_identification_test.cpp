#include "papers/fopdt_identification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "model/column_model.hpp"

namespace fpc {
namespace fuzzy_fopdt_identification_test {

Vector numeratorOf(const Fopdt& element, double sample_time, int terms) {
  const SampledFopdt lag = sampled(element, sample_time);
  Vector b = Vector::Zero(terms);
  b[lag.delay] = element.gain * lag.near;
  if (lag.delay + 1 < terms) b[lag.delay + 1] = element.gain * lag.far;
  return b;
}

TEST(RecoverFopdt, InvertsTheSamplingForAnyDeadTime) {
  for (double theta = 0.0; theta <= 7.01; theta += 0.173) {
    const Fopdt truth{-3.0, 5.0, theta};
    const auto found = recoverFopdt(std::exp(-1.0 / 5.0), numeratorOf(truth, 1.0, 12), 1.0);
    ASSERT_TRUE(found.has_value()) << theta;
    EXPECT_NEAR(found->gain, -3.0, 1e-12);
    EXPECT_NEAR(found->time_constant, 5.0, 1e-12);
    EXPECT_NEAR(found->dead_time, theta, 1e-12);
  }
}

TEST(RecoverFopdt, RoundingErrsByHalfASample) {
  const Fopdt truth{1.0, 5.0, 2.5};
  const auto found = recoverFopdtRounded(std::exp(-1.0 / 5.0), numeratorOf(truth, 1.0, 12), 1.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(std::abs(found->dead_time - 2.5), 0.5, 1e-12);
}

TEST(RecoverFopdt, SaysNothingWhereNothingCanBeRead) {
  const Vector b = (Vector(3) << 1.0, -1.0, 0.0).finished();
  EXPECT_FALSE(recoverFopdt(0.9, b, 1.0).has_value()) << "the sum of b is 0";
  const Vector one = Vector::Unit(3, 0);
  for (const double a : {-0.1, 0.0, 1.0, 1.1, std::nan("")})
    EXPECT_FALSE(recoverFopdt(a, one, 1.0).has_value()) << a;
  EXPECT_FALSE(recoverFopdt(0.9, one * std::nan(""), 1.0).has_value());
  const Vector early = (Vector(3) << 2.0, 0.0, -1.0).finished();
  EXPECT_FALSE(recoverFopdt(0.9, early, 1.0).has_value()) << "centroid before the input";
}

/// An element driven by a binary signal of +-1 held for 5 samples.
struct Record {
  Matrix inputs;  ///< n_u samples
  Vector y;       ///< y[k] answers inputs up to column k-1
};
Record excite(const std::vector<Fopdt>& row, int samples, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto n_u = static_cast<Eigen::Index>(row.size());
  Record record{Matrix(n_u, samples), Vector::Zero(samples)};
  std::vector<LagResponse> lags;
  for (const auto& element : row) lags.emplace_back(element, 1.0);
  for (int k = 0; k < samples; ++k)
    for (Eigen::Index j = 0; j < n_u; ++j) {
      const bool draw = (k + 2 * static_cast<int>(j)) % 5 == 0 || k == 0;
      record.inputs(j, k) = draw ? (generator() & 1U ? 1.0 : -1.0) : record.inputs(j, k - 1);
      const auto i = static_cast<std::size_t>(j);
      if (k + 1 < samples)
        record.y[k + 1] += row[i].gain * lags[i].advance(record.inputs(j, k));
      else
        lags[i].advance(record.inputs(j, k));
    }
  return record;
}

double standardDeviation(const Vector& y) {
  return std::sqrt((y.array() - y.mean()).square().mean());
}

void feed(MisoEstimator& estimator, const Record& record, double noise_std, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (Eigen::Index k = 1; k < record.y.size(); ++k)
    estimator.update(record.inputs.col(k - 1), record.y[k] + noise_std * normal(generator));
}

/// The sample from which on gain, lag and dead time are within 1 %.
int samplesNeeded(const Fopdt& truth, std::uint64_t seed) {
  MisoParams params;
  params.bias = false;
  const Record record = excite({truth}, 60, seed);
  MisoEstimator estimator(1, 1.0, params);
  int last_wrong = 0;
  for (Eigen::Index k = 1; k < 60; ++k) {
    estimator.update(record.inputs.col(k - 1), record.y[k]);
    const auto found = estimator.element(0);
    const bool right = found && std::abs(found->gain / truth.gain - 1.0) < 0.01 &&
                       std::abs(found->time_constant / truth.time_constant - 1.0) < 0.01 &&
                       std::abs(found->dead_time - truth.dead_time) < 0.01 * truth.dead_time;
    if (!right) last_wrong = static_cast<int>(k);
  }
  return last_wrong + 1;
}

/// Records differ in when their input first changes sign: an input that has not moved shows
/// nothing.
TEST(MisoEstimator, FindsOneElementInAtMostTwentyNoiseFreeSamples) {
  for (const auto& row : test::columnMatrix())
    for (const Fopdt& truth : row) {
      std::vector<int> needed;
      for (std::uint64_t seed = 1; seed <= 21; ++seed) needed.push_back(samplesNeeded(truth, seed));
      std::sort(needed.begin(), needed.end());
      std::cout << "gain " << truth.gain << ": samples to 1 % " << needed.front() << " .. "
                << needed.back() << ", median " << needed[10] << "\n";
      EXPECT_LE(needed[10], 20);
    }
}

TEST(MisoEstimator, FindsAFractionalDeadTime) {
  MisoParams params;
  const Record record = excite({{2.0, 8.0, 3.37}}, 200, 2);
  MisoEstimator estimator(1, 1.0, params);
  feed(estimator, record, 0.0, 1);
  ASSERT_TRUE(estimator.element(0).has_value());
  EXPECT_NEAR(estimator.element(0)->dead_time, 3.37, 1e-3);
  EXPECT_NEAR(estimator.element(0)->time_constant, 8.0, 1e-2);
}

/// Relative errors of K and tau of G11 over seeds: 600 samples.
std::pair<double, double> biasOf(const MisoParams& params, double noise, int samples = 600) {
  const Fopdt truth{12.8, 16.7, 1.0};
  double gain = 0.0, tau = 0.0;
  constexpr int kRuns = 20;
  for (int run = 0; run < kRuns; ++run) {
    const Record record = excite({truth}, samples, 100U + static_cast<unsigned>(run));
    MisoEstimator estimator(1, 1.0, params);
    feed(estimator, record, noise * standardDeviation(record.y), 200U + static_cast<unsigned>(run));
    const auto found = estimator.element(0);
    if (!found) return {NAN, NAN};
    gain += (found->gain / truth.gain - 1.0) / kRuns;
    tau += (found->time_constant / truth.time_constant - 1.0) / kRuns;
  }
  return {gain, tau};
}

TEST(MisoEstimator, IsBiasedByNoiseWhichMoreDataDoNotCureAndOutputErrorIsNot) {
  MisoParams arx, robust;
  arx.bias = robust.bias = false;
  robust.method = MisoMethod::kOutputError;
  std::cout << "noise/std(y)   ARX: K, tau [%]   output error: K, tau [%]\n";
  for (const double noise : {0.01, 0.02, 0.05, 0.1}) {
    const auto [k, tau] = biasOf(arx, noise);
    const auto [k_oe, tau_oe] = biasOf(robust, noise);
    std::cout << noise << "   " << 100 * k << ", " << 100 * tau << "   " << 100 * k_oe << ", "
              << 100 * tau_oe << "\n";
    EXPECT_LT(std::abs(k_oe), 0.01) << noise;
    EXPECT_LT(std::abs(tau_oe), 0.02) << noise;
  }
  const auto [k, tau] = biasOf(arx, 0.05);
  EXPECT_LT(k, -0.03);
  EXPECT_LT(tau, -0.06);
  const auto [k_long, tau_long] = biasOf(arx, 0.05, 6000);
  std::cout << "0.05, 6000 samples: ARX " << 100 * k_long << ", " << 100 * tau_long << "\n";
  EXPECT_LT(k_long, -0.03);
  EXPECT_LT(tau_long, -0.06);
}

TEST(MisoEstimator, KeepsOnePercentOfNoiseWithinOneAndTwoPercentAlsoWhenForgetting) {
  for (const MisoMethod method : {MisoMethod::kArx, MisoMethod::kOutputError})
    for (const double forgetting : {0.995, 1.0}) {
      MisoParams params;
      params.bias = false;
      params.method = method;
      params.rls.forgetting = forgetting;
      const auto [k, tau] = biasOf(params, 0.01);
      EXPECT_LT(std::abs(k), 0.01) << static_cast<int>(method) << forgetting;
      EXPECT_LT(std::abs(tau), 0.02) << static_cast<int>(method) << forgetting;
    }
}

TEST(MisoEstimator, SeparatesTwoElementsInTheirMeasuredSum) {
  const auto matrix = test::columnMatrix();
  for (const auto& row : matrix) {
    MisoParams params;
    params.numerator_terms = 12;
    const Record record = excite({row[0], row[1]}, 1500, 7);
    MisoEstimator estimator(2, 1.0, params);
    int last_wrong = 0;
    for (Eigen::Index k = 1; k < record.y.size(); ++k) {
      estimator.update(record.inputs.col(k - 1), record.y[k] + 3.0);
      bool right = true;
      for (int j = 0; j < 2; ++j) {
        const Fopdt& truth = row[static_cast<std::size_t>(j)];
        const auto found = estimator.element(j);
        right = right && found && std::abs(found->gain / truth.gain - 1.0) < 0.01 &&
                std::abs(found->time_constant / truth.time_constant - 1.0) < 0.01 &&
                std::abs(found->dead_time - truth.dead_time) < 0.1;
      }
      if (!right) last_wrong = static_cast<int>(k);
    }
    std::cout << "measured sum: within 1 % after " << last_wrong + 1 << " samples\n";
    EXPECT_LT(last_wrong + 1, 800);
    EXPECT_NEAR(estimator.gain(0), row[0].gain, 0.01 * std::abs(row[0].gain));
    EXPECT_NEAR(estimator.gain(1), row[1].gain, 0.01 * std::abs(row[1].gain));
  }
}

TEST(MisoEstimator, BoundsItsCovarianceAndStaysPutWithoutExcitation) {
  const Fopdt truth{12.8, 16.7, 1.0};
  const auto drift = [&](int quiet_steps, double* largest) {
    MisoParams params;
    params.bias = false;
    params.rls = {0.98, 1e6, 1e6};
    params.quiet_steps = quiet_steps;
    MisoEstimator estimator(1, 1.0, params);
    const Record record = excite({truth}, 300, 3);
    feed(estimator, record, 0.05, 3);
    const double before = estimator.theta()[0];
    std::mt19937_64 generator(5);
    std::normal_distribution<double> normal;
    const Vector still = Vector::Zero(1);
    for (int k = 0; k < 1500; ++k) estimator.update(still, 0.05 * normal(generator));
    *largest = estimator.leastSquares().covariance().diagonal().maxCoeff();
    return std::abs(estimator.theta()[0] - before);
  };
  double largest = 0.0;
  const double loose = drift(0, &largest);
  EXPECT_LE(largest, 1e6 * (1.0 + 1e-9));
  const double gated = drift(100, &largest);
  std::cout << "drift of a over 1500 quiet samples: " << loose << ", gated " << gated << "\n";
  EXPECT_GT(loose, 0.5) << "noise alone teaches a = 0";
  EXPECT_LT(gated, 0.1);
}

TEST(MisoEstimator, SkipsWhatIsNotFinite) {
  MisoEstimator estimator(1, 1.0, {});
  const Vector u = Vector::Ones(1);
  for (int k = 0; k < 20; ++k) estimator.update(u * (k % 3), 0.1 * k);
  EXPECT_FALSE(estimator.update(u, std::nan("")));
  EXPECT_FALSE(estimator.update(u, 1.0)) << "the NaN is still among the regressors";
  EXPECT_TRUE(estimator.theta().allFinite());
}

TEST(MisoEstimator, GoesOnAfterWhatIsNotFinite) {
  for (const MisoMethod method : {MisoMethod::kArx, MisoMethod::kOutputError})
    for (const bool of_input : {true, false}) {
      MisoParams params;
      params.method = method;
      const Record record = excite({{2.0, 8.0, 3.0}}, 600, 3);
      MisoEstimator estimator(1, 1.0, params);
      int learned = 0;
      for (Eigen::Index k = 1; k < record.y.size(); ++k) {
        const bool spoiled = k == 5 || k == 300;  // in the warm-up and after it
        Vector u = record.inputs.col(k - 1);
        if (spoiled && of_input) u[0] = NAN;
        learned += estimator.update(u, spoiled && !of_input ? NAN : record.y[k]);
      }
      EXPECT_GT(learned, 500) << static_cast<int>(method) << of_input;
      ASSERT_TRUE(estimator.element(0).has_value()) << static_cast<int>(method) << of_input;
      EXPECT_NEAR(estimator.element(0)->gain, 2.0, 0.1) << static_cast<int>(method) << of_input;
      EXPECT_NEAR(estimator.element(0)->time_constant, 8.0, 0.5)
          << static_cast<int>(method) << of_input;
    }
}

TEST(MisoEstimator, RefusesWhatItCannotDo) {
  MisoParams params;
  params.method = MisoMethod::kOutputError;
  EXPECT_THROW(MisoEstimator(2, 1.0, params), InputError);
  EXPECT_THROW(MisoEstimator(3, 1.0, {}), InputError);
  params = {};
  params.rls.forgetting = 0.0;
  EXPECT_THROW(MisoEstimator(1, 1.0, params), InputError);
}

}  // namespace fuzzy_fopdt_identification_test
}  // namespace fpc
