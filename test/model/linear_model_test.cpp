#include "model/linear_model.hpp"

#include <gtest/gtest.h>

#include <random>

#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/column_model.hpp"
#include "paths.hpp"

namespace fpc {
namespace fuzzy_linear_model_test {

double valueOf(const Regressor& r, const Matrix& outputs, const Matrix& inputs, Eigen::Index k) {
  const Matrix& from = r.kind == SignalKind::kOutput ? outputs : inputs;
  return from(r.index, std::max<Eigen::Index>(0, k - r.lag));
}

TEST(LinearModel, PredictsItsElementsExactlyAlsoWithFractionalDeadTimes) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  TsModel names = test::columnModel(60.0, false);
  FopdtMatrix m = test::columnMatrix();
  m[0][0].dead_time = 1.4;
  m[1][0].dead_time = 6.7;
  std::vector<LinearElement> elements;
  std::vector<LagResponse> lags;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const Fopdt& e = m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      elements.push_back({i, SignalKind::kInput, j, e});
      lags.emplace_back(e, 1.0);
    }
  const Vector rest = (Vector(2) << 96.25, 0.5).finished();
  const TsModel model = linearModel(names, elements, {rest, Vector::Zero(2), Vector()});
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  constexpr Eigen::Index kSamples = 120;
  Matrix inputs = Matrix::Zero(2, kSamples), outputs(2, kSamples + 1);
  for (double& u : flat(inputs).tail(2 * (kSamples - 20))) u = any(generator);
  outputs.col(0) = rest;
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    outputs.col(k + 1) = rest;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        outputs(static_cast<Eigen::Index>(i), k + 1) +=
            m[i][j].gain * lags[2 * i + j].advance(inputs(static_cast<Eigen::Index>(j), k));
  }
  for (Eigen::Index k = 12; k < kSamples; ++k)
    for (std::size_t i = 0; i < 2; ++i) {
      const OutputModel& sub = model.submodels[i];
      double y = sub.rules[0].offset;
      for (std::size_t r = 0; r < sub.regressors.size(); ++r)
        y += sub.rules[0].coefficients[static_cast<Eigen::Index>(r)] *
             valueOf(sub.regressors[r], outputs, inputs, k);
      EXPECT_NEAR(y, outputs(static_cast<Eigen::Index>(i), k + 1), 1e-10);
    }
}

/// 2 / (5 s + 1) from an input, a load behind the same lag: 1 - exp(-t / 5 s) of a step.
TEST(LinearModel, ALoadMayShareThePolesOfAnElement) {
  TsModel names = test::columnModel(1.0, true);
  names.outputs.resize(1);
  names.inputs.resize(1);
  const SampledElement lag = sampled(ProcessElement{2.0, 5.0}, 1.0),
                       load = sampled(ProcessElement{1.0, 5.0}, 1.0);
  const TsModel model = linearModel(
      names, {{0, SignalKind::kInput, 0, lag}, {0, SignalKind::kDisturbance, 0, load, 0}},
      {Vector::Zero(1), Vector::Zero(1), Vector::Zero(1)});
  const OutputModel& sub = model.submodels[0];
  ASSERT_EQ(sub.regressors.size(), 3U) << "one lag of the output";
  double y = 0.0;
  for (int k = 1; k < 20; ++k) {
    y = sub.rules[0].coefficients[0] * y + sub.rules[0].coefficients[2];
    EXPECT_NEAR(y, -std::expm1(-k / 5.0), 1e-12);
  }
}

TEST(LinearModel, IsWhatTheShippedColumnModelsHold) {
  for (const bool feed : {false, true}) {
    const TsModel model = test::columnModel(60.0, feed);
    const TsModel shipped = readModel(sourceDir() + "/config/model/" + model.name + ".yaml");
    EXPECT_EQ(writeModel(shipped), writeModel(model));
  }
}

TEST(LinearModel, RefusesElementsOfNobody) {
  const TsModel names = test::columnModel(60.0, false);
  const LinearPoint point{Vector::Zero(2), Vector::Zero(2), Vector()};
  const Fopdt e{1.0, 1.0, 0.0};
  EXPECT_THROW(linearModel(names, {{0, SignalKind::kInput, 0, e}}, point), InputError);
  EXPECT_THROW(
      linearModel(names, {{0, SignalKind::kInput, 2, e}, {1, SignalKind::kInput, 0, e}}, point),
      InputError);
  EXPECT_THROW(linearModel(names, std::vector<LinearElement>{},
                           {Vector::Zero(1), Vector::Zero(2), Vector()}),
               InputError);
}

}  // namespace fuzzy_linear_model_test
}  // namespace fpc
