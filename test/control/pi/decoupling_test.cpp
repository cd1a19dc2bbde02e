#include "control/pi/decoupling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "model/column_model.hpp"

namespace fpc {
namespace control_pi_decoupling_test {

using Pair = std::array<double, 2>;

/// y of the column for c, with what the decoupling gives taken `sign` times (1 is right).
std::vector<Pair> answer(const FopdtMatrix& m, double dt, const std::vector<Pair>& asked,
                         double sign = 1.0) {
  InvertedDecoupling decoupling(m, dt);
  std::vector<LagResponse> lags;
  for (const auto& row : m)
    for (const auto& element : row) lags.emplace_back(element, dt);
  std::vector<Pair> outputs;
  for (const Pair& c : asked) {
    decoupling.apply(c);
    Pair u = c;
    for (std::size_t i = 0; i < 2; ++i) u[i] -= sign * decoupling.cross()[i];
    decoupling.record(u[0], u[1]);
    Pair y{};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) y[i] += m[i][j].gain * lags[2 * i + j].advance(u[j]);
    outputs.push_back(y);
  }
  return outputs;
}

double largest(const std::vector<Pair>& outputs, std::size_t i) {
  double value = 0.0;
  for (const Pair& y : outputs) value = std::max(value, std::abs(y[i]));
  return value;
}

TEST(InvertedDecoupling, LeavesEachOutputToItsOwnLoopAndNothingElse) {
  const FopdtMatrix m = test::columnMatrix();
  for (const double dt : {0.02, 0.1, 1.0}) {
    const auto samples = static_cast<std::size_t>(60.0 / dt);
    const auto top = answer(m, dt, std::vector<Pair>(samples, {0.1, 0.0}));
    EXPECT_LT(largest(top, 1), 1e-12) << dt;
    const auto bottom = answer(m, dt, std::vector<Pair>(samples, {0.0, 0.1}));
    EXPECT_LT(largest(bottom, 0), 1e-12) << dt;
    LagResponse own(m[0][0], dt);
    for (const Pair& y : top) EXPECT_NEAR(y[0], 12.8 * own.advance(0.1), 1e-12);
  }
}

TEST(InvertedDecoupling, CouplesHarderWhenAddedInsteadOfSubtracted) {
  const FopdtMatrix m = test::columnMatrix();
  const std::vector<Pair> step(3000, {0.1, 0.0});
  EXPECT_LT(largest(answer(m, 0.02, step, 1.0), 1), 1e-12);
  EXPECT_GT(largest(answer(m, 0.02, step, 0.0), 1), 0.5);
  EXPECT_GT(largest(answer(m, 0.02, step, -1.0), 1), 1.0);
}

TEST(InvertedDecoupling, InterpolatesADelayThatIsNoWholeNumberOfSamples) {
  FopdtMatrix m = test::columnMatrix();
  m[0][1].dead_time = 3.4;
  const auto coupled = answer(m, 1.0, std::vector<Pair>(60, {0.0, 0.1}), 0.0);
  const auto decoupled = answer(m, 1.0, std::vector<Pair>(60, {0.0, 0.1}));
  EXPECT_LT(largest(decoupled, 0), 0.02 * largest(coupled, 0));
}

TEST(InvertedDecoupling, CanLetOneInputFollowTheOtherWithinTheSample) {
  FopdtMatrix m = test::columnMatrix();
  m[0][1].dead_time = m[0][0].dead_time;  // L waits for V at the same sample
  for (const Pair& c : {Pair{0.1, 0.0}, Pair{0.0, 0.1}}) {
    const auto y = answer(m, 1.0, std::vector<Pair>(60, c));
    EXPECT_LT(largest(y, c[0] > 0.0 ? 1 : 0), 1e-12);
  }
  std::swap(m[0], m[1]);
  for (auto& row : m) std::swap(row[0], row[1]);
  EXPECT_LT(largest(answer(m, 1.0, std::vector<Pair>(60, {0.1, 0.0})), 1), 1e-12);
}

TEST(InvertedDecoupling, RefusesInWordsWhatNeedsTheFuture) {
  FopdtMatrix m = test::columnMatrix();
  m[0][1].dead_time = 0.5;
  const std::string words = InvertedDecoupling::refusal(m, 1.0);
  EXPECT_NE(words.find("output 1"), std::string::npos) << words;
  EXPECT_NE(words.find("future"), std::string::npos) << words;
  EXPECT_THROW(InvertedDecoupling(m, 1.0), InputError);
}

TEST(InvertedDecoupling, RefusesInWordsAnAlgebraicLoop) {
  FopdtMatrix m = test::columnMatrix();
  m[0][1].dead_time = m[0][0].dead_time;
  m[1][0].dead_time = m[1][1].dead_time;
  EXPECT_NE(InvertedDecoupling::refusal(m, 1.0).find("wait"), std::string::npos);
  EXPECT_THROW(InvertedDecoupling(m, 1.0), InputError);
  EXPECT_EQ(InvertedDecoupling::refusal(test::columnMatrix(), 1.0), "");
  EXPECT_NE(InvertedDecoupling::refusal(test::columnMatrix(), 5.0), "") << "4 min are no sample";
}

TEST(InvertedDecoupling, TakesNewGainsAtOnce) {
  FopdtMatrix m = test::columnMatrix();
  InvertedDecoupling decoupling(m, 1.0);
  decoupling.rest(0.0, 0.1);
  decoupling.apply({0.0, 0.0});
  EXPECT_NEAR(decoupling.cross()[0], 0.1 * -18.9 / 12.8, 1e-12);
  decoupling.setGains({{{15.36, -15.12}, {7.92, -15.52}}});
  decoupling.apply({0.0, 0.0});
  EXPECT_NEAR(decoupling.cross()[0], 0.1 * -15.12 / 15.36, 1e-12);
}

}  // namespace control_pi_decoupling_test
}  // namespace fpc
