// Search over structures, judged by free runs over held-out blocks.
#include "identification/auto_identify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identified_model.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_auto_identify_test {

using Eigen::Index;
using Law = std::function<double(double y, double u)>;

/// y(k+1) = law(y(k), u(k - delay)) + noise of the sensor, u held for a while.
DataSet simulate(const Law& law, Index rows, double noise, int delay, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  DataSet data;
  data.source = "simulated";
  data.sample_time_s = 1.0;
  data.values.resize(rows, 2);
  double y = 0.0, u = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 6 == 0) u = 2.0 * uniform(random) - 1.0;
    data.values.row(k) << y + noise * standardNormal(random), u;
    y = law(y, data.values(std::max<Index>(0, k - delay), 1));
  }
  const auto info = [&](const char* name, Index c) {
    return SignalInfo{name, "", data.values.col(c).minCoeff(), data.values.col(c).maxCoeff()};
  };
  data.outputs = {info("y", 0)};
  data.inputs = {info("u", 1)};
  data.constant.assign(2, false);
  return data;
}

double linearLaw(double y, double u) { return 0.85 * y + 0.3 * u; }
/// Fast above zero, slow below.
double bentLaw(double y, double u) { return y + (y > 0.0 ? 0.35 : 0.08) * (u - y); }

AutoParams quick(bool states) {
  AutoParams p;
  p.states = states;
  p.budget_s = 300.0;
  return p;
}

double freeRunError(const TsModel& model, const DataSet& data) {
  return fitFigures(data.values.col(0), predictFreeRun(model, data).col(0)).rmse;
}

TEST(AutoIdentify, SaysThatALinearProcessIsLinear) {
  const DataSet data = simulate(linearLaw, 240, 0.02, 0, 1);
  const AutoIdentification found = autoIdentify(data, quick(false));
  ASSERT_EQ(found.outputs.size(), 1U);
  EXPECT_FALSE(found.outputs[0].beats_linear) << found.outputs[0].verdict;
  const DataSet other = simulate(linearLaw, 300, 0.0, 0, 7);
  EXPECT_LT(freeRunError(found.linear, other), 0.01);
  EXPECT_LT(freeRunError(found.model, other), 1.05 * freeRunError(found.linear, other) + 0.005);
}

TEST(AutoIdentify, BeatsLinearWhereTheProcessBends) {
  const DataSet data = simulate(bentLaw, 300, 0.01, 0, 2);
  const AutoIdentification found = autoIdentify(data, quick(false));
  const AutoOutput& y = found.outputs[0];
  EXPECT_TRUE(y.beats_linear) << y.verdict;
  EXPECT_EQ(y.best, ModelKind::kRegressors);
  EXPECT_EQ(y.verdict.rfind("the fuzzy model beats linear", 0), 0U) << y.verdict;
  const DataSet other = simulate(bentLaw, 400, 0.0, 0, 9);
  EXPECT_LT(freeRunError(found.model, other), 0.5 * freeRunError(found.linear, other));
  EXPECT_GT(y.regressors.free_run,
            0.9 * freeRunError(found.model, data));  // held out beside fitted
}

TEST(AutoIdentify, FindsADelay) {
  const DataSet data = simulate(linearLaw, 300, 0.01, 3, 3);
  const AutoIdentification found = autoIdentify(data, quick(false));
  EXPECT_EQ(found.outputs[0].delay, std::vector<int>{3});
}

TEST(AutoIdentify, FindsALongDelayAndSaysWhenItEndsTheSearch) {
  const DataSet data = simulate(linearLaw, 400, 0.02, 20, 3);
  AutoIdentification found = autoIdentify(data, quick(false));
  EXPECT_EQ(found.outputs[0].delay, std::vector<int>{20});
  EXPECT_LT(freeRunError(found.linear, simulate(linearLaw, 400, 0.0, 20, 8)), 0.02);
  const auto told = [&] {
    for (const auto& r : found.remarks)
      if (r.find("the longest that was tried") != std::string::npos) return true;
    return false;
  };
  EXPECT_FALSE(told());
  AutoParams params = quick(false);
  params.longest_delay = 20;
  found = autoIdentify(data, params);
  EXPECT_TRUE(told());
}

TEST(AutoIdentify, LeavesOutAnInputThatHardlyMovedUnlessTold) {
  DataSet data = simulate(linearLaw, 200, 0.02, 0, 1);
  data.inputs.push_back({"v", "", 3.0, 3.01});
  data.constant.assign(3, false);
  data.values.conservativeResize(200, 3);
  data.values.col(2).setConstant(3.0);
  data.values.col(2).segment(100, 10).setConstant(3.01);
  const auto uses = [](const AutoIdentification& found) {
    for (const auto& r : found.linear.submodels[0].regressors)
      if (r.kind == SignalKind::kInput && r.index == 1) return true;
    return false;
  };
  const AutoIdentification found = autoIdentify(data, quick(false));
  EXPECT_FALSE(uses(found));
  ASSERT_FALSE(found.remarks.empty());
  EXPECT_EQ(found.remarks[0].rfind("v is left out", 0), 0U) << found.remarks[0];
  AutoParams keep = quick(false);
  keep.keep_still = true;
  EXPECT_TRUE(uses(autoIdentify(data, keep)));
}

TEST(AutoIdentify, SaysFirstThatNoiseCannotBePredicted) {
  std::mt19937_64 random(8);
  const Law noise = [&random](double, double) { return standardNormal(random); };
  const AutoIdentification found = autoIdentify(simulate(noise, 240, 0.0, 0, 4), quick(false));
  EXPECT_EQ(found.outputs[0].verdict.rfind("no model says ", 0), 0U) << found.outputs[0].verdict;
  EXPECT_FALSE(found.outputs[0].beats_linear);
}

TEST(AutoIdentify, WorkIsCountedSoThatThreadsAndTimeChangeNothing) {
  const DataSet data = simulate(bentLaw, 240, 0.05, 0, 6);
  AutoParams params = quick(false);
  params.work = 0.1;  // ends in the middle of the search
  params.threads = 1;
  const AutoIdentification one = autoIdentify(data, params);
  params.threads = 3;
  const AutoIdentification three = autoIdentify(data, params);
  EXPECT_EQ(one.work, three.work);
  EXPECT_EQ(one.remarks, three.remarks);
  ASSERT_EQ(one.trials.size(), three.trials.size());
  for (std::size_t i = 0; i < one.trials.size(); ++i) {
    EXPECT_EQ(one.trials[i].structure, three.trials[i].structure);
    EXPECT_EQ(one.trials[i].free_run, three.trials[i].free_run);
  }
  const auto isLeftOut = [](const AutoIdentification& found) {
    return std::any_of(found.remarks.begin(), found.remarks.end(), [](const std::string& r) {
      return r.find("limit of work left out") != std::string::npos;
    });
  };
  EXPECT_TRUE(isLeftOut(one));
  params.work = 45.0;
  const AutoIdentification whole = autoIdentify(data, params);
  EXPECT_FALSE(isLeftOut(whole));
  EXPECT_GT(whole.work, one.work);
}

TEST(AutoIdentify, ARuleCountsTheRowsInWhichItFiresMostAndItsCentresLieInTheData) {
  const DataSet data = simulate(bentLaw, 300, 0.01, 0, 2);
  const AutoIdentification found = autoIdentify(data, quick(false));
  const OutputModel& model = found.model.submodels[0];
  ASSERT_GT(model.rules.size(), 1U);
  const Regression rows = makeRegression(data, model.regressors, model.antecedents, 0);
  std::vector<std::uint64_t> counts(model.rules.size(), 0);
  FiringResult firing;
  for (Index k = 0; k < rows.rows(); ++k) {
    firingWeights(model, rows.antecedents.row(k).transpose(), firing);
    Index most = 0;
    firing.weights.maxCoeff(&most);
    ++counts[static_cast<std::size_t>(most)];
  }
  for (std::size_t r = 0; r < counts.size(); ++r) {
    EXPECT_EQ(model.rules[r].data_count, counts[r]);
    for (std::size_t j = 0; j < model.antecedents.size(); ++j) {
      const auto column =
          data.values.col(data.column(model.antecedents[j].kind, model.antecedents[j].index));
      const double centre = model.rules[r].antecedents[j].parameters[0];
      EXPECT_GE(centre, column.minCoeff() - 1e-9);
      EXPECT_LE(centre, column.maxCoeff() + 1e-9);
    }
  }
}

TEST(AutoIdentify, OffersTheBestLinearModelOfItsTable) {
  const AutoIdentification found = autoIdentify(simulate(bentLaw, 240, 0.05, 0, 6), quick(false));
  const AutoTrial* first = nullptr;
  for (const auto& t : found.trials)
    if (t.kind == ModelKind::kLinear && first == nullptr) first = &t;
  ASSERT_NE(first, nullptr);
  EXPECT_TRUE(first->chosen) << first->structure;
  EXPECT_NEAR(first->free_run, found.outputs[0].linear.mean, 1e-12);
}

TEST(AutoIdentify, SameDataSameModelWhateverTheThreads) {
  const DataSet data = simulate(bentLaw, 120, 0.01, 0, 4);
  AutoParams one = quick(false), two = one;
  one.threads = 1;
  two.threads = 3;
  const auto a = autoIdentify(data, one), b = autoIdentify(data, two);
  EXPECT_EQ(freeRunError(a.model, data), freeRunError(b.model, data));
  EXPECT_EQ(a.outputs[0].verdict, b.outputs[0].verdict);
}

TEST(AutoIdentify, StopKeepsTheBestSoFar) {
  const DataSet data = simulate(bentLaw, 120, 0.01, 0, 4);
  int calls = 0;
  const AutoIdentification found =
      autoIdentify(data, quick(false), [&calls](const AutoProgress&) { return ++calls < 8; });
  EXPECT_TRUE(found.cancelled);
  EXPECT_EQ(found.model.submodels.size(), 1U);
  ASSERT_FALSE(found.remarks.empty());
}

TEST(AutoIdentify, AStateOfItsOwnSeesTheSizeOfASignedMotion) {
  // y = |speed|: no function of the past of y tells which way it turns
  double speed = 0.0;
  const Law law = [&speed](double, double u) {
    speed = 0.9 * speed + 0.4 * u;
    return std::abs(speed);
  };
  const DataSet data = simulate(law, 200, 0.005, 0, 5);
  const AutoIdentification found = autoIdentify(data, quick(true));
  ASSERT_EQ(found.outputs[0].best, ModelKind::kState) << found.outputs[0].verdict;
  EXPECT_TRUE(found.outputs[0].beats_linear);
  EXPECT_LT(found.outputs[0].state.free_run, 0.3 * found.outputs[0].linear.free_run);
  const IdentifiedModel model = toIdentified(found);
  speed = 0.0;
  const DataSet other = simulate(law, 200, 0.0, 0, 11);
  const KindPrediction best = predictBest(model, other);
  const double error = fitFigures(other.values.col(0), best.free_run.col(0)).rmse;
  EXPECT_LT(error, 0.5 * freeRunError(found.linear, other));
  EXPECT_GT(coverage(other.values.col(0), best.free_run.col(0), best.free_run_width[0]), 80.0);
}

TEST(AutoIdentify, ThinsALongRecordAndSaysSo) {
  const DataSet data = simulate(bentLaw, 3000, 0.01, 0, 6);
  AutoParams params = quick(false);
  params.most_rows = 200;
  params.most_last = 400;
  const AutoIdentification found = autoIdentify(data, params);
  ASSERT_FALSE(found.remarks.empty());
  EXPECT_EQ(found.remarks[0],
            "long record: the search uses 200 rows in 4 windows, the last fit 400 of 3000 rows");
  EXPECT_LT(freeRunError(found.model, data), 0.6 * freeRunError(found.linear, data));
}

TEST(AutoIdentify, SaysFirstThatNothingIsToBeTrusted) {
  DataSet data = simulate(bentLaw, 150, 0.005, 0, 3);
  data.values.col(1).setConstant(2.0);  // what moved the output was not recorded
  const AutoIdentification found = autoIdentify(data, quick(false));
  const AutoOutput& y = found.outputs[0];
  EXPECT_EQ(y.verdict.rfind("no model says more than the mean", 0), 0U) << y.verdict;
  EXPECT_FALSE(y.beats_linear);
  EXPECT_EQ(found.model.submodels[0].rules.size(), 1U);
}

TEST(AutoIdentify, UnitsDoNotMatter) {
  const DataSet data = simulate(bentLaw, 150, 0.005, 0, 3);
  DataSet other = data;
  other.values.col(0) *= 1e-6;
  other.values.col(1) *= 1e6;
  for (auto* signals : {&other.outputs, &other.inputs})
    for (auto& s : *signals) {
      const double unit = signals == &other.outputs ? 1e-6 : 1e6;
      s.lower *= unit;
      s.upper *= unit;
    }
  const auto a = autoIdentify(data, quick(false)), b = autoIdentify(other, quick(false));
  EXPECT_EQ(a.outputs[0].best, b.outputs[0].best);
  EXPECT_NEAR(1e6 * b.outputs[0].linear.free_run, a.outputs[0].linear.free_run, 1e-6);
  EXPECT_NEAR(1e6 * b.outputs[0].regressors.free_run, a.outputs[0].regressors.free_run, 1e-3);
}

TEST(AutoIdentify, RefusesWhatItCannotSearch) {
  DataSet data = simulate(linearLaw, 40, 0.0, 0, 1);
  EXPECT_THROW(autoIdentify(data, quick(false)), InputError);
  data = simulate(linearLaw, 100, 0.0, 0, 1);
  AutoParams params = quick(false);
  params.blocks = 1;
  EXPECT_THROW(autoIdentify(data, params), InputError);
  data.inputs.clear();
  EXPECT_THROW(autoIdentify(data, quick(false)), InputError);
}

}  // namespace fuzzy_auto_identify_test
}  // namespace fpc
