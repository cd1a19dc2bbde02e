// Zeros, relative degree and the three propositions of blazic2007 for all their rules.
#include "analysis/transfer.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_transfer_test {

constexpr double kA1[] = {-1.3462, -1.4506, -1.5681, -1.7114, -1.8111, -1.9157};
constexpr double kA2[] = {0.4298, 0.5262, 0.6437, 0.7689, 0.8592, 0.9485};
constexpr double kB[] = {1.8124e-4, 2.1795e-4, 2.7762e-4, 2.6703e-4, 2.8716e-4, 2.85e-4};

TEST(Propositions, HoldForEveryRuleOfTheStirredTank) {
  for (int i = 0; i < 6; ++i) {
    const Propositions found = checkPropositions(canonicalRule(kA1[i], kA2[i], kB[i]), 3000);
    EXPECT_EQ(found.relative_degree, 2);
    EXPECT_EQ(found.gain_below, 0.0) << "exactly, rule " << i + 1;
    EXPECT_LE(found.zeros_distance, 1e-6) << i + 1;
    EXPECT_LE(found.poles_distance, 1e-6) << i + 1;
  }
}

TEST(Propositions, HoldWithAZeroInsideTheUnitCircle) {
  // (0.5 z + 0.2) / ((z - 0.9)(z - 0.6)(z - 0.3))
  LinearModel model{AffineModel(3, 1, 1), Matrix::Zero(1, 3)};
  model.affine.A << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.162, -0.99, 1.8;
  model.affine.B << 0.0, 0.0, 1.0;
  model.affine.C << 0.2, 0.5, 0.0;
  const Transfer transfer = transferOf(model.affine, 0, 0);
  EXPECT_EQ(transfer.relative_degree, 2);
  ASSERT_EQ(transfer.zeros.size(), 1U);
  EXPECT_NEAR(transfer.zeros[0].real(), -0.4, 1e-12);
  const Propositions found = checkPropositions(model, 3000);
  EXPECT_EQ(found.gain_below, 0.0);
  EXPECT_LE(found.zeros_distance, 1e-6);
  EXPECT_LE(found.poles_distance, 1e-6);
}

TEST(SmallestStableHorizon, ExceedsTheRelativeDegreeOfANonMinimumPhasePlant) {
  // (z - 2) / ((z - 0.8)(z - 0.5)): gain against the first move
  LinearModel model{AffineModel(2, 1, 1), Matrix::Zero(1, 2)};
  model.affine.A << 0.0, 1.0, -0.4, 1.3;
  model.affine.B << 0.0, 1.0;
  model.affine.C << -2.0, 1.0;
  LoopLaw law;
  law.coincidence_steps = 1;
  EXPECT_GT(spectralRadius(closeLoop(model, law).values), 1.0);
  const int smallest = smallestStableHorizon(model, law, 100);
  ASSERT_GT(smallest, 1);
  law.coincidence_steps = smallest;
  EXPECT_LT(spectralRadius(closeLoop(model, law).values), 1.0);
  law.coincidence_steps = smallest - 1;
  const ClosedLoop shorter = closeLoop(model, law);
  EXPECT_TRUE(!shorter.applicable || spectralRadius(shorter.values) >= 1.0);
}

TEST(Transfer, OfAnInputThatNeverArrivesHasNoRelativeDegree) {
  AffineModel model(1, 1, 1);
  model.A << 0.5;
  model.C << 1.0;
  EXPECT_EQ(transferOf(model, 0, 0).relative_degree, 0);
  EXPECT_THROW(transferOf(model, 1, 0), InputError);
}

}  // namespace analysis_transfer_test
}  // namespace fpc
