// The first truly multivariable constrained loop: the closed-loop paradigm on the Wood-Berry column
// against clipping, and against a plain constrained linear predictive controller.
#include <cstdio>

#include <random>

#include "fmbpc/model/model_match.hpp"
#include "model/linear_model.hpp"
#include "paper/column_run.hpp"
#include "paper/plain_mpc.hpp"
#include "papers/fopdt_identification.hpp"
#include "runtime/report.hpp"

namespace fpc {
namespace paper_column_clp_test {

using test::columnIndices;
using test::columnRun;

struct Outcome {
  double top{}, bottom{};      ///< ISE over the samples, mol%^2
  double y2_below{}, y_out{};  ///< largest excess of the lower limit of x_B, of any limit
  std::uint64_t violations{};
};

Outcome outcome(const char* title, const LoopFile& loop) {
  const RunRecord run = runLoop(loop);
  const Summary summary = summarize(loop, run, 0.0);
  Outcome o;
  o.top = columnIndices(run, 0).ise;
  o.bottom = columnIndices(run, 1).ise;
  for (const auto& sample : run.samples) {
    const Vector& y = sample.state.outputs;
    o.y2_below = std::max(o.y2_below, -0.05 - y[1]);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      o.y_out = std::max(
          {o.y_out, loop.report.output_lower[k] - y[i], y[i] - loop.report.output_upper[k]});
    }
  }
  o.violations = summary.input_violations + summary.move_violations;
  std::printf(
      "%-36s ISE y_D %.3f, x_B %.3f; x_B below its limit by %.4f, largest excess %.4f, "
      "violations %llu\n",
      title, o.top, o.bottom, o.y2_below, o.y_out, static_cast<unsigned long long>(o.violations));
  return o;
}

Outcome outcome(const char* title, const std::string& name, const Overrides& overrides = {}) {
  return outcome(title, readLoop(name, overrides));
}

TEST(ColumnClp, BeatsClippingByAQuarterAndKeepsEveryLimit) {
  const Outcome clip = outcome("clipped (13.83/2.22, 0.216)", "column_clip");
  const Outcome least = outcome("least perturbation (13.48/2.06)", "column_clp");
  const Outcome limits = outcome("least perturbation, output limits", "column_clp_limits");
  const Outcome tracking = outcome("tracking (8.69/2.98, 0)", "column_clp_tracking");
  EXPECT_NEAR(clip.top, 13.83, 0.01);
  EXPECT_NEAR(clip.bottom, 2.22, 0.01);
  EXPECT_NEAR(clip.y2_below, 0.216, 0.001);
  EXPECT_NEAR(least.top, 13.48, 0.03);
  EXPECT_NEAR(least.bottom, 2.06, 0.03);
  EXPECT_NEAR(tracking.top, 8.69, 0.01);
  EXPECT_NEAR(tracking.bottom, 2.98, 0.01);
  EXPECT_LE(tracking.top, 0.75 * clip.top);
  EXPECT_LT(tracking.y2_below, 1e-6);
  EXPECT_LT(tracking.y_out, 1e-6);
  EXPECT_LT(limits.y_out, clip.y_out);
  EXPECT_EQ(clip.violations + least.violations + limits.violations + tracking.violations, 0U);
}

TEST(ColumnClp, WithALawTunedAsAWholeItBeatsClippingInBothOutputs) {
  const Outcome clip = outcome("clipped", "column_clip");
  const Outcome tuned = outcome("tuned", "column_clp_tracking_tuned");
  EXPECT_LE(tuned.top, 0.75 * clip.top);
  EXPECT_LT(tuned.bottom, clip.bottom);
  EXPECT_LT(tuned.y_out, 1e-6);
  EXPECT_EQ(tuned.violations, 0U);
}

TEST(ColumnClp, DoesAsWellAsAPlainConstrainedLinearController) {
  const Outcome tracking = outcome("tracking", "column_clp_tracking");
  for (const double weight : {0.1, 10.0, 1000.0}) {
    test::PlainMpcSettings settings;
    settings.move_weight = weight;
    test::PlainMpc baseline(settings);
    double top = 1.0, bottom = 0.25, excess = 0.0;  // of sample 0
    for (int k = 0; k < 150; ++k) {
      const Vector y = baseline.step();
      top += (1.0 - y[0]) * (1.0 - y[0]);
      bottom += (-0.5 - y[1]) * (-0.5 - y[1]);
      excess = std::max(
          {excess, (y - settings.output_upper).maxCoeff(), (settings.output_lower - y).maxCoeff()});
      EXPECT_LE(baseline.input().cwiseAbs().maxCoeff(), 0.25 + 1e-9);
    }
    EXPECT_FALSE(baseline.failed());
    std::printf("plain MPC, move weight %-8g ISE y_D %.3f, x_B %.3f, largest excess %.4f\n", weight,
                top, bottom, excess);
    EXPECT_LT(tracking.top + tracking.bottom, 1.03 * (top + bottom));
  }
}

TEST(ColumnClp, IsHelpedByAMeasuredFeedAndKeepsItsLimitsWithoutIt) {
  const Overrides feed = {{"disturbance.commands", "[{time_h: 1.2, name: F, value: 0.05}]"}};
  Overrides measured = feed;
  measured.emplace_back("plant.measured_disturbances", "[F]");
  measured.emplace_back("model.file", "wood_berry_feed.yaml");
  const Outcome blind = outcome("tracking, unmeasured feed", "column_clp_tracking", feed);
  const Outcome seeing = outcome("tracking, measured feed", "column_clp_tracking", measured);
  const Outcome clip = outcome("clipped, unmeasured feed", "column_clip", feed);
  outcome("clipped, measured feed", "column_clip", measured);
  EXPECT_LE(seeing.top, blind.top);
  EXPECT_LT(seeing.bottom, blind.bottom);
  EXPECT_LE(blind.top, 0.75 * clip.top);
  EXPECT_EQ(blind.violations + seeing.violations, 0U);
  EXPECT_LT(seeing.y_out, 1e-6);
}

/// Both elements of an output from 900 samples of its measured sum.
std::vector<LinearElement> identifiedRow(int output) {
  MisoParams params;
  params.numerator_terms = 12;
  MisoEstimator estimator(2, 1.0, params);
  const auto row = test::columnMatrix()[static_cast<std::size_t>(output)];
  std::vector<LagResponse> lags{LagResponse(row[0], 1.0), LagResponse(row[1], 1.0)};
  std::mt19937_64 generator(11);
  Vector u = Vector::Zero(2);
  for (int k = 0; k < 900; ++k) {
    for (Eigen::Index j = 0; j < 2; ++j)
      if ((k + 2 * j) % 5 == 0) u[j] = generator() & 1U ? 1.0 : -1.0;
    const double y = row[0].gain * lags[0].advance(u[0]) + row[1].gain * lags[1].advance(u[1]);
    estimator.update(u, y);
  }
  std::vector<LinearElement> elements;
  for (int j = 0; j < 2; ++j) {
    const auto found = estimator.element(j);
    EXPECT_TRUE(found.has_value());
    if (found) elements.push_back({output, SignalKind::kInput, j, *found});
  }
  return elements;
}

TEST(ColumnClp, WorksTheSameOnAModelIdentifiedFromTheMeasuredSums) {
  std::vector<LinearElement> elements = identifiedRow(0);
  for (const auto& element : identifiedRow(1)) elements.push_back(element);
  LoopFile loop = readLoop("column_clp_tracking");
  const LinearPoint point{(Vector(2) << 96.25, 0.5).finished(), Vector::Zero(2), Vector()};
  loop.model =
      matchToPlant(linearModel(test::columnModel(60.0, false), elements, point), loop.plant_info);
  const Outcome identified = outcome("tracking, identified model", loop);
  const Outcome clip = outcome("clipped", "column_clip");
  EXPECT_LE(identified.top, 0.75 * clip.top);
  EXPECT_LT(identified.y2_below, 0.01);
  EXPECT_EQ(identified.violations, 0U);
}

}  // namespace paper_column_clp_test
}  // namespace fpc
