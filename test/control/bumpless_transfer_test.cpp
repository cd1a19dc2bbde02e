#include "fmbpc/control/bumpless_transfer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fpc {
namespace control_bumpless_transfer_test {

Vector one(double value) { return Vector::Constant(1, value); }

double applied(BumplessTransfer& transfer, double input_applied, double proposal) {
  Vector input = one(proposal);
  transfer.apply(one(input_applied), input);
  return input[0];
}

TEST(BumplessTransfer, FirstInputIsTheAppliedOneAndTheBiasDiesOut) {
  BumplessTransfer transfer(1, 0.5);
  transfer.reset(true);
  EXPECT_EQ(applied(transfer, 7.0, 3.0), 7.0);  // bias 4
  transfer.fade();
  EXPECT_EQ(applied(transfer, 7.0, 3.0), 5.0);
  transfer.fade();
  EXPECT_EQ(applied(transfer, 7.0, 10.0), 11.0);
}

TEST(BumplessTransfer, WithoutOneNothingChanges) {
  BumplessTransfer transfer(1, 0.5);
  transfer.reset(false);
  EXPECT_EQ(applied(transfer, 7.0, 3.0), 3.0);
}

TEST(BumplessTransfer, WaitsForAFiniteProposal) {
  BumplessTransfer transfer(1, 0.5);
  transfer.reset(true);
  EXPECT_TRUE(std::isnan(applied(transfer, 7.0, std::nan(""))));
  EXPECT_EQ(applied(transfer, 7.0, 3.0), 7.0);
}

TEST(BumplessTransfer, BetweenTwoLawsTheOlderOnesInputIsKept) {
  BumplessTransfer transfer(1, 0.5);
  transfer.reset(true);
  EXPECT_EQ(applied(transfer, 7.0, 3.0), 7.0);
  transfer.begin(one(7.0));
  EXPECT_EQ(applied(transfer, 6.0, 9.0), 9.0);  // the younger law alone
  Vector input = one(9.0);
  transfer.finish(input);
  EXPECT_EQ(input[0], 7.0);  // bias -2
  Matrix plan = Matrix::Constant(1, 3, 9.0);
  transfer.addTo(plan);
  EXPECT_EQ(plan, (Matrix(1, 3) << 7.0, 8.0, 8.5).finished());
}

}  // namespace control_bumpless_transfer_test
}  // namespace fpc
