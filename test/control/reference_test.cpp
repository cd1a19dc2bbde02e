#include "fmbpc/control/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_reference_test {

using test::pair;

TEST(ReferenceTrajectory, StartsAtTheOutputAndApproachesAHeldSetpointGeometrically) {
  ReferenceTrajectory reference(pair(0.76, 0.96), false);
  reference.reset(pair(200.0, 2000.0));
  SetpointSource setpoint = test::setpointOf(test::activatedSludgeInfo(), pair(55.0, 2200.0));
  setpoint.advance(0);
  Matrix future(2, 30);
  reference.predict(setpoint, 0, future);
  EXPECT_EQ(reference.present(), pair(200.0, 2000.0));
  for (int i = 0; i < 30; ++i) {
    EXPECT_NEAR(future(0, i), 55.0 + std::pow(0.76, i + 1) * 145.0, 1e-11);
    EXPECT_NEAR(future(1, i), 2200.0 - std::pow(0.96, i + 1) * 200.0, 1e-11);
  }
}

TEST(ReferenceTrajectory, IsHeldBackWithinReachOfTheOutputs) {
  ReferenceTrajectory reference(pair(0.5, 0.9), false);
  reference.reset(pair(1.0, 2.0));
  EXPECT_FALSE(reference.holdBack(pair(1.25, -90.0), pair(0.25, kInfinity)));
  EXPECT_EQ(reference.present(), pair(1.0, 2.0));
  EXPECT_TRUE(reference.holdBack(pair(1.5, -90.0), pair(0.25, kInfinity)));
  EXPECT_EQ(reference.present(), pair(1.25, 2.0));
  EXPECT_TRUE(reference.holdBack(pair(1.5, 1.0), pair(0.5, 0.125)));
  EXPECT_EQ(reference.present(), pair(1.25, 1.125));
  EXPECT_EQ(reference.asked(), pair(1.0, 2.0));
  SetpointSource setpoint = test::setpointOf(test::activatedSludgeInfo(), pair(2.0, 4.0));
  setpoint.advance(0);
  reference.advance(setpoint, 0);
  EXPECT_EQ(reference.asked(), pair(1.5, 0.9 * 2.0 + (1.0 - 0.9) * 4.0));
  EXPECT_EQ(reference.present(), pair(1.625, 0.9 * 1.125 + (1.0 - 0.9) * 4.0));
  ReferenceTrajectory other(pair(0.0, 0.0), false);
  other.goOnFrom(reference);
  EXPECT_EQ(other.asked(), reference.asked());
  EXPECT_EQ(other.present(), reference.present());
}

TEST(ReferenceTrajectory, ColumnsThatAreAskedForAloneAreThoseOfTheWholePath) {
  SetpointSource setpoint = test::setpointOf(test::activatedSludgeInfo(), pair(55.0, 2200.0),
                                             {{10.0, pair(60.0, 2100.0)}});
  setpoint.advance(0);
  for (const bool preview : {false, true})
    for (const Eigen::Index first : {0, 1, 32, 33, 100, 199}) {
      ReferenceTrajectory reference(pair(0.0, 0.96), preview);
      reference.reset(pair(200.0, 2000.0));
      Matrix whole(2, 200), part = Matrix::Constant(2, 200, -1.0);
      reference.predict(setpoint, 0, whole);
      reference.predict(setpoint, 0, part, first);
      EXPECT_TRUE((part.leftCols(first).array() == -1.0).all()) << "left as they were";
      const double tolerance = first > 32 && !preview ? 1e-12 : 0.0;  // a power at once
      EXPECT_LE((part - whole).rightCols(200 - first).cwiseAbs().maxCoeff(), 2200.0 * tolerance)
          << first;
    }
}

TEST(ReferenceTrajectory, AdvancesOntoItsOwnPrediction) {
  for (const bool preview : {false, true}) {
    ReferenceTrajectory reference(pair(0.5, 0.9), preview);
    reference.reset(pair(1.0, 2.0));
    SetpointSource setpoint = test::setpointOf(test::activatedSludgeInfo(), pair(3.0, 4.0));
    Matrix future(2, 3);
    for (std::uint32_t k = 0; k < 10; ++k) {
      setpoint.advance(k);
      reference.predict(setpoint, k, future);
      reference.advance(setpoint, k);
      EXPECT_EQ(reference.present(), future.col(0));
    }
  }
}

TEST(ReferenceTrajectory, PreviewFollowsTheScheduleAndOtherwiseThePresentSetpointIsHeld) {
  const double hour = 1.0;  // five samples of 720 s
  SetpointSource setpoint = test::setpointOf(test::activatedSludgeInfo(), pair(55.0, 2000.0),
                                             {{hour, pair(60.0, 2100.0)}});
  setpoint.advance(0);
  Matrix held(2, 8), ahead(2, 8);
  ReferenceTrajectory without(pair(0.0, 0.0), false), with(pair(0.0, 0.0), true);
  without.reset(pair(55.0, 2000.0));
  with.reset(pair(55.0, 2000.0));
  without.predict(setpoint, 0, held);
  with.predict(setpoint, 0, ahead);
  for (int i = 0; i < 8; ++i) {  // column i is y_r(i+1); preview knows the setpoint of sample i+1
    EXPECT_EQ(held(1, i), 2000.0);
    EXPECT_EQ(ahead(1, i), i >= 4 ? 2100.0 : 2000.0) << i;
  }
}

TEST(ReferenceTrajectory, PolesOutsideTheUnitIntervalAreRefused) {
  EXPECT_THROW(ReferenceTrajectory(pair(0.5, 1.0), false), InputError);
  EXPECT_THROW(ReferenceTrajectory(pair(-0.1, 0.5), false), InputError);
  EXPECT_THROW(ReferenceTrajectory(pair(std::nan(""), 0.5), false), InputError);
}

}  // namespace control_reference_test
}  // namespace fpc
