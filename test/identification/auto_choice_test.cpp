// The last fit of a structure that was judged over held-out blocks.
#include "identification/auto_choice.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace fpc {
namespace fuzzy_auto_choice_test {

using Eigen::Index;

/// Pole 0.6 below u = 0.5, then towards one at 1.2: held there, y grows without end. Such inputs
/// come in the last rows only, and for two samples.
DataSet record() {
  std::mt19937_64 random(4);
  DataSet data;
  data.source = "simulated";
  data.sample_time_s = 1.0;
  data.values.resize(500, 2);
  double y = 0.0, u = 0.0;
  for (Index k = 0; k < 500; ++k) {
    if (k % 5 == 0) u = uniform(random) - 0.5;
    const double input = k >= 400 && k % 10 < 3 ? 1.3 : u;
    data.values.row(k) << y + 1e-3 * standardNormal(random), input;
    y = (input > 0.5 ? 1.25 : 0.6) * y + 0.4 * input;
  }
  data.outputs = {{"y", "", data.values.col(0).minCoeff(), data.values.col(0).maxCoeff()}};
  data.inputs = {{"u", "", data.values.col(1).minCoeff(), data.values.col(1).maxCoeff()}};
  data.constant.assign(2, false);
  return data;
}

Judgement judged() {
  Judgement j;
  j.candidate.order = 1;
  j.candidate.input_terms = 1;
  j.candidate.delay = {0};
  j.candidate.rules = 2;
  j.candidate.antecedents = AntecedentChoice::kInputs;
  j.rmse = 1.0;
  return j;
}

TEST(AutoChoice, WhatRunsAwayFittedToAllRowsIsFittedToThoseOfTheSearch) {
  const DataSet data = record();
  AutoData prepared = prepareAuto(data, 0, 4, 2000, 8000);
  prepared.all = {{0, 500}};
  prepared.windows = {{0, 500}};
  const Fitted wild = fitWhole(prepared, judged(), 5, kInfinity);
  EXPECT_FALSE(wild.finite);
  EXPECT_TRUE(wild.wild);
  prepared.windows = {{0, 200}, {200, 400}};
  const Fitted tame = fitWhole(prepared, judged(), 5, kInfinity);
  EXPECT_TRUE(tame.finite);
  EXPECT_EQ(tame.rows, 400);
}

TEST(AutoChoice, StatesOfTheirOwnThatRunAwayAreRefusedToo) {
  const DataSet data = record();
  const AutoData prepared = prepareAuto(data, 0, 4, 2000, 8000);
  Candidate c = judged().candidate;
  c.hidden = true;
  const Fitted wild = fitCandidate(prepared, c, {{0, 500}});
  EXPECT_TRUE(wild.wild);
  EXPECT_FALSE(wild.finite) << "the rests that are known of it, none, must not make it good";
  const Fitted tame = fitCandidate(prepared, c, {{0, 400}});
  EXPECT_TRUE(tame.finite);
}

}  // namespace fuzzy_auto_choice_test
}  // namespace fpc
