// The first truly multivariable constrained loop: the closed-loop paradigm on the Wood-Berry column
// against clipping, and against a plain constrained linear predictive controller.
#include <cstdio>

#include "fmbpc/loop/report.hpp"
#include "paper/column_run.hpp"

namespace fpc {
namespace {

using test::columnIndices;
using test::columnRun;

struct Outcome {
  double top{}, bottom{};       ///< ISE over the samples, mol%^2
  double y2_below{}, y_out{};   ///< largest excess of the lower limit of x_B, of any limit
  std::uint64_t violations{};
};

Outcome outcome(const char* title, const std::string& name, const Overrides& overrides = {}) {
  const LoopFile loop = readLoop(name, overrides);
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
      o.y_out = std::max({o.y_out, loop.report.output_lower[k] - y[i], y[i] - loop.report.output_upper[k]});
    }
  }
  o.violations = summary.input_violations + summary.move_violations;
  std::printf("%-36s ISE y_D %.3f, x_B %.3f; x_B below its limit by %.4f, largest excess %.4f, "
              "violations %llu\n",
              title, o.top, o.bottom, o.y2_below, o.y_out,
              static_cast<unsigned long long>(o.violations));
  return o;
}

TEST(ColumnClp, BeatsClippingByAQuarterAndKeepsEveryLimit) {
  const Outcome clip = outcome("clipped (13.83/2.22, 0.216)", "column_clip");
  const Outcome least = outcome("least perturbation (13.48/2.06)", "column_clp");
  const Outcome tracking = outcome("tracking (8.69/2.98, 0)", "column_clp_tracking");
  EXPECT_NEAR(clip.top, 13.83, 0.14);
  EXPECT_NEAR(clip.bottom, 2.22, 0.03);
  EXPECT_NEAR(clip.y2_below, 0.216, 0.005);
  EXPECT_LE(least.top, clip.top);
  EXPECT_LE(tracking.top, 0.75 * clip.top);
  EXPECT_LT(tracking.y2_below, 1e-6);
  EXPECT_EQ(clip.violations + least.violations + tracking.violations, 0U);
}

}  // namespace
}  // namespace fpc
