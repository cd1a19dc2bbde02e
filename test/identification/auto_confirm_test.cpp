#include "identification/auto_confirm.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace fuzzy_auto_confirm_test {

/// Two blocks of three rows around zero; a judgement errs by `errors` in each.
class AutoConfirm : public ::testing::Test {
 protected:
  AutoConfirm() {
    record_.values = Matrix::Zero(6, 1);
    data_.data = &record_;
    data_.windows = {{0, 3}, {3, 6}};
  }
  static Judgement judgement(double first, double second) {
    Judgement j;
    j.free_run.resize(6);
    j.free_run << first, first, first, second, second, second;
    j.one_step = Vector::Constant(6, kNaN);
    j.parameters = 1;
    return j;
  }
  DataSet record_;
  AutoData data_;
};

TEST_F(AutoConfirm, EachBlockIsJudgedByWhatTheOtherBlockChose) {
  StructureSearch found;
  found.regressors = {judgement(1.0, 9.0), judgement(5.0, 2.0)};
  const Confirmation confirmed = confirmChoices(data_, found);
  ASSERT_EQ(confirmed.regressors.size(), 6);
  EXPECT_EQ(confirmed.regressors[0], 5.0);  // the second block chose the second
  EXPECT_EQ(confirmed.regressors[3], 9.0);  // the first block chose the first
  EXPECT_EQ(confirmed.linear.size(), 0);
}

}  // namespace fuzzy_auto_confirm_test
}  // namespace fpc
