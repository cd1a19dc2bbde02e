#include "identification/process_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/closed_loop_record.hpp"

namespace fpc {
namespace process_fit_test {

using Eigen::Index;
using test::Data;
using test::record;
using test::Response;

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
    if (trial % 4 == 1 && e.time_constant > 0.0) {
      e.second = e.time_constant;
      e.damping = 0.1 + 0.9 * uniform(engine);
    }
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

// As of an exothermic reactor: no two real lags give such a response.
TEST(ProcessFit, FindsAPairOfComplexPoles) {
  ProcessElement e = lag(2.0, 8.0, 2.4, 8.0, -3.0);
  e.damping = 0.4;
  const Data d = record(e, 0.1, 0.01, 1.0, {0.05}, 600, 3);
  const ElementEstimate found = fitProcess(d.u, d.y, 1.0).elements[0];
  EXPECT_NEAR(found.element.damping, 0.4, 0.03);
  EXPECT_NEAR(found.element.time_constant, 8.0, 0.3);
  EXPECT_NEAR(found.element.gain, 2.0, 2.0 * found.gain_bound);
  EXPECT_LT(found.gain_bound, 0.1);
}

// A fast effect and a slow one of the other sign, which no single lag begins to describe.
TEST(ProcessFit, FindsAFastEffectAgainstASlowOne) {
  const ProcessElement e = lag(-1.0, 40.0, 1.0, 3.0, -60.0);
  const Data d = record(e, 0.0, 0.0, 1.0, {0.02}, 800, 8);
  const ProcessFit fit = fitProcess(d.u, d.y, 1.0);
  EXPECT_EQ(fit.kind, ProcessKind::kStable);
  EXPECT_NEAR(fit.elements[0].element.gain, -1.0, 2.0 * fit.elements[0].gain_bound);
  EXPECT_LT(fit.one_step, 0.021);
}

// Two lags that are one have no split that a record could show: every member has some.
TEST(ProcessFit, MembersOfTheEnsembleHaveLagsLikeTheRecords) {
  const ProcessElement e = lag(2.0, 8.0, 3.0, 8.0);
  const Data d = record(e, 0.0, 0.0, 1.0, {0.05}, 400, 2);
  for (const auto& member : fitProcess(d.u, d.y, 1.0).ensemble) {
    EXPECT_GT(member[0].lags(), 10.0);
    EXPECT_LT(member[0].lags(), 25.0);
    EXPECT_LT(member[0].settling(), 60.0);
  }
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

// Under a PI and a drift a long lag is hardly told from an integrator.
TEST(ProcessFit, AnEffectWhoseEndTheRecordDoesNotShowIsThatOfAnIntegrator) {
  ProcessElement e = lag(-0.1, 0.0, 1.0, 3.3);
  e.integrating = true;
  constexpr int kRecords = 60;
  int kinds = 0, gains = 0, delays = 0;
  for (int s = 0; s < kRecords; ++s) {
    const Data d = record(e, -0.5, -0.012, 1.0, {0.12, 0.026, 0.06, 0.001}, 1200, 100 + s);
    const ProcessFit fit = fitProcess(d.u, d.y, 1.0);
    const ElementEstimate& found = fit.elements[0];
    kinds += fit.kind == ProcessKind::kIntegrating;
    gains += std::abs(found.element.gain - e.gain) <= found.gain_bound;
    delays += std::abs(found.element.dead_time - e.dead_time) <= found.dead_time_bound;
  }
  EXPECT_GE(kinds, 52);
  EXPECT_GE(gains, 52);  // with 95 % fewer have a chance of 1 in 1,000
  EXPECT_GE(delays, 52);
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

// Two loops that drift and disturb each other: how the weak effect begins is seen, not where it
// ends.
TEST(ProcessFit, AWeakEffectHasNoLagOfHours) {
  const ProcessElement strong = lag(0.4, 11.0, 1.5, 1.5), weak = lag(0.16, 13.0, 4.0, 12.0);
  constexpr Index kRows = 700;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    auto engine = seededEngine(seed, {11});
    Response own[2] = {Response(strong), Response(strong)};
    Response cross[2] = {Response(weak), Response(weak)};
    Matrix u = Matrix::Zero(kRows, 2), y = Matrix::Zero(kRows, 2);
    double drift[2] = {0.0, 0.0}, integral[2] = {0.0, 0.0}, level[2] = {0.0, 0.0};
    for (Index k = 0; k < kRows; ++k)
      for (int i = 0; i < 2; ++i) {
        drift[i] += 0.05 * standardNormal(engine);
        y(k, i) = own[i].next(u.col(i)) + cross[i].next(u.col(1 - i)) + drift[i] +
                  0.1 * standardNormal(engine);
        if (uniform(engine) < 0.15) level[i] = uniform(engine) < 0.5 ? -2.0 : 2.0;
        integral[i] -= 0.1 * y(k, i);
        u(k, i) = k == 0 ? 0.0 : integral[i] - 1.0 * y(k, i) + level[i];
      }
    const ElementEstimate found = fitProcess(u, y.col(0), 1.0).elements[1];
    if (found.gain_bound >= std::abs(found.element.gain)) {
      EXPECT_LE(found.element.lags(), 4.0 * strong.lags()) << seed;
    }
  }
}

TEST(ProcessFit, MissingRowsAreLeftOut) {
  const ProcessElement e = lag(2.0, 12.0, 3.0);
  Data d = record(e, 0.0, 0.0, 1.0, {0.01}, 400, 7);
  for (Index k = 50; k < 400; k += 60) d.y[k] = std::nan("");
  EXPECT_NEAR(fitProcess(d.u, d.y, 1.0).elements[0].element.gain, 2.0, 0.02);
}

// An analyser that answers three times of four, and a disturbance that is unknown at first.
TEST(ProcessFit, ManyMissingRowsAndAFirstOneCostRowsAndNotTheFit) {
  const ProcessElement e = lag(2.0, 12.0, 3.0);
  Data d = record(e, 0.0, 0.0, 1.0, {0.01}, 400, 7);
  auto engine = seededEngine(3, {});
  for (double& y : d.y)
    if (uniform(engine) < 0.25) y = std::nan("");
  Matrix u(400, 2);
  u << d.u.col(0), Vector::Ones(400);
  u.col(1).head(3).setConstant(std::nan(""));
  const ProcessFit fit = fitProcess(u, d.y, 1.0);
  EXPECT_NEAR(fit.elements[0].element.gain, 2.0, 0.02);
  EXPECT_GT(fit.rows, 100);
  EXPECT_FALSE(fit.elements[1].seen);
}

// Mole fractions in 1e-9 and an input in 1e6 W: the same process in other units.
TEST(ProcessFit, DoesNotDependOnUnits) {
  const ProcessElement e = lag(2.0, 15.0, 4.3, 3.0);
  const Data d = record(e, 0.5, 0.06, 0.5, {0.1, 0.02}, 500, 9);
  const ProcessFit here = fitProcess(d.u, d.y, 1.0);
  const ProcessFit there = fitProcess(1e6 * d.u, 1e-9 * d.y, 1.0);
  const ProcessElement &a = here.elements[0].element, &b = there.elements[0].element;
  EXPECT_NEAR(b.gain, 1e-15 * a.gain, 1e-19);
  EXPECT_NEAR(b.lags(), a.lags(), 1e-3 * a.lags());
  EXPECT_NEAR(b.dead_time, a.dead_time, 1e-3);
  EXPECT_NEAR(there.one_step, 1e-9 * here.one_step, 1e-13);
  EXPECT_NEAR(there.output, 1e-9 * here.output, 1e-12);
  EXPECT_NEAR(there.elements[0].gain_bound, 1e-15 * here.elements[0].gain_bound, 1e-18);
  ASSERT_EQ(there.noise.size(), here.noise.size());
  EXPECT_NEAR((there.noise - here.noise).norm(), 0.0, 1e-3);
  const auto calm = noiseBeside(there, 1e6 * d.u, 1e-9 * d.y, 1.0);
  ASSERT_TRUE(calm.has_value());
  EXPECT_NEAR(calm->one_step, there.one_step, 0.05 * there.one_step);
}

// An output that nothing moves has no element, rather than one of its noise.
TEST(ProcessFit, AnOutputThatNothingMovesHasNoElement) {
  int none = 0;
  for (int seed = 0; seed < 10; ++seed) {
    const Data d = record(lag(0.0, 5.0, 0.0), 0.0, 0.0, 1.0, {0.1}, 400, 20 + seed);
    none += fitProcess(d.u, d.y, 1.0).elements[0].seen ? 0 : 1;
  }
  EXPECT_GE(none, 8);
}

TEST(ProcessFit, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(fitProcess(Matrix::Zero(100, 1), Vector::Zero(100), 1.0), InputError);
  EXPECT_THROW(fitProcess(Matrix::Random(20, 1), Vector::Zero(20), 1.0), InputError);
  EXPECT_THROW(fitProcess(Matrix::Random(100, 1), Vector::Zero(90), 1.0), InputError);
}

/// Columns of `inputs` that stand still, and an output of autoregressive noise behind a pole.
Data calm(double pole, double past, double sigma, Index rows, std::uint64_t seed) {
  auto engine = seededEngine(seed, {});
  Data d;
  d.u = Matrix::Constant(rows, 1, 3.0);
  d.y.resize(rows);
  double r = 0.0, y = 0.0;
  for (Index k = 0; k < rows; ++k) {
    r = past * r + sigma * standardNormal(engine);
    y = pole * y + r;
    d.y[k] = 40.0 + y;
  }
  return d;
}

TEST(ProcessNoise, IsFoundWhereTheInputsStandStill) {
  for (const ProcessKind kind :
       {ProcessKind::kStable, ProcessKind::kIntegrating, ProcessKind::kUnstable}) {
    ProcessFit fit;
    fit.kind = kind;
    fit.elements.resize(1);
    fit.elements[0].element = lag(2.0, kind == ProcessKind::kUnstable ? -50.0 : 12.0, 1.0);
    fit.elements[0].element.integrating = kind == ProcessKind::kIntegrating;
    fit.elements[0].seen = true;
    const double pole = kind == ProcessKind::kStable        ? 0.0
                        : kind == ProcessKind::kIntegrating ? 1.0
                                                            : std::exp(1.0 / 50.0);
    const Data d = calm(pole, 0.6, 0.05, 400, 5);
    const auto noise = noiseBeside(fit, d.u, d.y, 1.0);
    ASSERT_TRUE(noise.has_value());
    ASSERT_GE(noise->terms.size(), 1);
    EXPECT_NEAR(noise->terms[0], 0.6, 0.12) << "three standard deviations";
    EXPECT_NEAR(noise->one_step, 0.05, 0.006);
  }
}

// A test that moves a bent plant leaves in its noise what is bent; normal operation does not.
TEST(ProcessNoise, OfNormalOperationLeavesOutWhatIsNotLinear) {
  const ProcessElement e = lag(2.0, 12.0, 3.4);
  Data d = record(e, 0.0, 0.0, 1.0, {0.02}, 600, 1);
  for (double& y : d.y) y += 0.2 * y * y;
  const ProcessFit fit = fitProcess(d.u, d.y, 1.0);
  EXPECT_GT(fit.free_run, 0.1);
  const Data quiet = calm(0.0, 0.0, 0.02, 200, 2);
  const auto noise = noiseBeside(fit, quiet.u, quiet.y, 1.0);
  ASSERT_TRUE(noise.has_value());
  EXPECT_LT(noise->terms.cwiseAbs().sum(), 0.3);
  EXPECT_NEAR(noise->one_step, 0.02, 0.004);
}

TEST(ProcessNoise, AsksForRowsAndForTheColumnsOfTheFit) {
  ProcessFit fit;
  fit.elements.resize(1);
  const Data few = calm(0.0, 0.0, 0.02, 35, 2);
  EXPECT_FALSE(noiseBeside(fit, few.u, few.y, 1.0).has_value());
  EXPECT_THROW(noiseBeside(fit, Matrix::Zero(35, 2), few.y, 1.0), InputError);
}

}  // namespace process_fit_test
}  // namespace fpc
