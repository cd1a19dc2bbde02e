#include "identification/process_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/linear_model.hpp"

namespace fpc {
namespace process_fit_test {

using Eigen::Index;

/// Output of an element, before noise, sample by sample.
class Response {
 public:
  explicit Response(const ProcessElement& element, double sample_time_s = 1.0)
      : s_(sampled(element, sample_time_s)), a_(product(s_.own, s_.shared)) {}
  /// y(k) from u(0..k-1), plus a load.
  double next(const Matrix& u, double load = 0.0) {
    const auto k = static_cast<Index>(y_.size());
    double value = load;
    for (std::size_t i = 0; i < s_.b.size(); ++i) {
      const Index at = k - 1 - s_.delay - static_cast<Index>(i);
      if (at >= 0) value += s_.b[i] * u(at, 0);
    }
    for (std::size_t i = 1; i < a_.size() && i <= y_.size(); ++i)
      value -= a_[i] * y_[y_.size() - i];
    y_.push_back(value);
    return value;
  }

 private:
  SampledElement s_;
  std::vector<double> a_, y_;
};

struct Noise {
  double measurement{}, drift{}, coloured{}, load{};
};

struct Data {
  Matrix u;
  Vector y;
};

/// A record under a PI whose output carries binary noise of random dwell.
Data record(const ProcessElement& element, double kp, double ki, double level, const Noise& noise,
            Index rows, std::uint64_t seed) {
  auto engine = seededEngine(seed, {3});
  Data d{Matrix::Zero(rows, 1), Vector(rows)};
  Response response(element);
  double drift = 0.0, coloured = 0.0, integral = 0.0, now = 0.0;
  int left = 0;
  for (Index k = 0; k < rows; ++k) {
    coloured = 0.9 * coloured + noise.coloured * standardNormal(engine);
    drift += noise.drift * standardNormal(engine);
    d.y[k] = response.next(d.u, noise.load * standardNormal(engine)) + drift + coloured +
             noise.measurement * standardNormal(engine);
    if (left-- <= 0) {
      left = static_cast<int>(3.0 * std::pow(10.0, uniform(engine)));
      now = uniform(engine) < 0.5 ? -level : level;
    }
    integral -= ki * d.y[k];
    d.u(k, 0) = k == 0 ? 0.0 : -kp * d.y[k] + integral + now;
  }
  return d;
}

ProcessElement lag(double gain, double tau, double dead_time, double second = 0.0,
                   double lead = 0.0) {
  ProcessElement e;
  e.gain = gain;
  e.time_constant = tau;
  e.second = second;
  e.lead = lead;
  e.dead_time = dead_time;
  return e;
}

TEST(ProcessElement, SamplesAreThoseOfTheStepResponse) {
  auto engine = seededEngine(1, {});
  for (int trial = 0; trial < 60; ++trial) {
    ProcessElement e =
        lag(4.0 * uniform(engine) - 2.0, 1.0 + 20.0 * uniform(engine), 6.0 * uniform(engine),
            trial % 2 ? 8.0 * uniform(engine) : 0.0, trial % 3 ? 6.0 * uniform(engine) - 3.0 : 0.0);
    e.integrating = trial % 4 == 0;
    if (trial % 5 == 0) e.time_constant = -e.time_constant - 20.0;
    if (e.integrating && e.second == 0.0) e.lead = 0.0;
    if (e.second == 0.0) e.lead = 0.0;
    const Matrix ones = Matrix::Ones(60, 1);
    Response response(e, 1.3);
    for (Index k = 0; k < 60; ++k) {
      const double expected = e.step(1.3 * static_cast<double>(k));
      EXPECT_NEAR(response.next(ones), expected, 1e-8 * (1.0 + std::abs(expected)))
          << trial << " " << k;
    }
  }
}

TEST(ProcessFit, WithoutNoiseTheElementIsFound) {
  const ProcessElement e = lag(2.0, 12.0, 3.4);
  const Data d = record(e, 0.0, 0.0, 1.0, {1e-4}, 300, 1);
  const ProcessFit fit = fitProcess(d.u, d.y, 1.0);
  EXPECT_EQ(fit.kind, ProcessKind::kStable);
  EXPECT_NEAR(fit.elements[0].element.gain, 2.0, 1e-3);
  EXPECT_NEAR(fit.elements[0].element.dead_time, 3.4, 0.01);
  EXPECT_NEAR(fit.elements[0].element.time_constant, 12.0, 0.02);
}

TEST(ProcessFit, BoundsHoldUnderFeedbackWithColouredNoiseAndDrift) {
  const ProcessElement e = lag(2.0, 15.0, 4.3);
  constexpr int kRecords = 40;
  int gains = 0, delays = 0;
  double mean = 0.0;
  for (int s = 0; s < kRecords; ++s) {
    const Data d = record(e, 0.8, 0.06, 0.5, {0.1, 0.02, 0.05}, 600, 100 + s);
    const ElementEstimate found = fitProcess(d.u, d.y, 1.0).elements[0];
    gains += std::abs(found.element.gain - e.gain) <= found.gain_bound;
    delays += std::abs(found.element.dead_time - e.dead_time) <= found.dead_time_bound;
    mean += found.element.gain / kRecords;
  }
  // 95 % are promised; fewer than 33 of 40 have a chance of 1 in 600 then.
  EXPECT_GE(gains, 33);
  EXPECT_GE(delays, 33);
  EXPECT_NEAR(mean, e.gain, 0.2);
}

TEST(ProcessFit, KnowsAnIntegratorAndAnUnstablePole) {
  ProcessElement integrator = lag(0.1, 0.0, 3.0, 4.0);
  integrator.integrating = true;
  const Data one = record(integrator, 0.8, 0.02, 0.5, {0.01, 0.0, 0.0, 0.005}, 500, 4);
  const ProcessFit first = fitProcess(one.u, one.y, 1.0);
  EXPECT_EQ(first.kind, ProcessKind::kIntegrating);
  EXPECT_NEAR(first.elements[0].element.gain, 0.1, 0.005);

  const ProcessElement unstable = lag(-2.0, -30.0, 2.0, 3.0);
  const Data two = record(unstable, 1.5, 0.03, 0.5, {0.005, 0.0, 0.0, 0.005}, 500, 5);
  const ProcessFit second = fitProcess(two.u, two.y, 1.0);
  EXPECT_EQ(second.kind, ProcessKind::kUnstable);
  EXPECT_NEAR(second.elements[0].element.time_constant, -30.0, 6.0);
}

TEST(ProcessFit, AnInputThatDoesNothingIsNotSeen) {
  const ProcessElement e = lag(2.0, 12.0, 3.0);
  Data d = record(e, 0.0, 0.0, 1.0, {0.05}, 400, 6);
  auto engine = seededEngine(9, {});
  d.u.conservativeResize(Eigen::NoChange, 2);
  for (Index k = 0; k < d.u.rows(); ++k) d.u(k, 1) = (k / 7) % 2 ? uniform(engine) : 0.0;
  const ProcessFit fit = fitProcess(d.u, d.y, 1.0);
  EXPECT_TRUE(fit.elements[0].seen);
  EXPECT_FALSE(fit.elements[1].seen);
  EXPECT_LT(fit.elements[1].gain_bound, 0.2);
}

TEST(ProcessFit, MissingRowsAreLeftOut) {
  const ProcessElement e = lag(2.0, 12.0, 3.0);
  Data d = record(e, 0.0, 0.0, 1.0, {0.01}, 400, 7);
  for (Index k = 50; k < 400; k += 60) d.y[k] = std::nan("");
  EXPECT_NEAR(fitProcess(d.u, d.y, 1.0).elements[0].element.gain, 2.0, 0.02);
}

TEST(ProcessFit, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(fitProcess(Matrix::Zero(100, 1), Vector::Zero(100), 1.0), InputError);
  EXPECT_THROW(fitProcess(Matrix::Random(20, 1), Vector::Zero(20), 1.0), InputError);
  EXPECT_THROW(fitProcess(Matrix::Random(100, 1), Vector::Zero(90), 1.0), InputError);
}

}  // namespace process_fit_test
}  // namespace fpc
