// The linear example of taieb2017 as loops: overshoot, offset, divergence.
#include <cstdio>

#include "paper/step_response.hpp"

namespace fpc {
namespace paper_linear_2x2_test {

using test::wholeRun;

Vector errorAt(const RunRecord& record, std::size_t k) {
  return record.samples[k].state.outputs - record.samples[k].tracking.setpoint;
}

TEST(Linear2x2, PrintedLawOvershootsAndMissesLittle) {
  const RunRecord record = wholeRun("linear_2x2");
  const double overshoot[2] = {23.57, 0.43}, setpoint[2] = {6.1, 12.8};
  for (Eigen::Index i = 0; i < 2; ++i) {
    const auto f = test::stepFigures(record, i, 0, 360, setpoint[i]);
    std::printf("y%ld: overshoot %.2f %%, offset %.2g\n", static_cast<long>(i) + 1, f.overshoot,
                errorAt(record, 360)[i]);
    EXPECT_NEAR(f.overshoot, overshoot[i], 0.005);
  }
  EXPECT_LE(errorAt(record, 360).cwiseAbs().maxCoeff(), 0.0025);
  EXPECT_GT(errorAt(record, 360).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Linear2x2, InputsDrawnToZeroLeaveAnOffset) {
  EXPECT_GT(errorAt(wholeRun("linear_2x2_zero"), 360).cwiseAbs().maxCoeff(), 0.1);
}

TEST(Linear2x2, EachInputByItselfDiverges) {
  const RunRecord record = wholeRun("linear_2x2_each");
  EXPECT_GT(errorAt(record, 20).norm(), 4.0 * errorAt(record, 10).norm());  // 1.1778^10 = 5.1
}

TEST(Linear2x2, MoveWeightsLeaveNone) {
  EXPECT_LT(errorAt(wholeRun("linear_2x2_move"), 360).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Linear2x2, WithActiveLimitsTheOptimizerBeatsClipping) {
  const auto squares = [](const char* name) {
    const RunRecord record = wholeRun(name);
    double sum = 0.0;
    for (std::size_t k = 0; k < record.samples.size(); ++k)
      sum += errorAt(record, k).cwiseQuotient(record.samples[k].tracking.setpoint).squaredNorm();
    std::printf("%-18s scaled squared errors %.4f\n", name, sum);
    return sum;
  };
  EXPECT_LT(squares("linear_2x2_clp"), 0.95 * squares("linear_2x2_limits"));
}

}  // namespace paper_linear_2x2_test
}  // namespace fpc
