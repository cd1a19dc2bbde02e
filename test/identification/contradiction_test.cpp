// A record that speaks against what is said to be known of its process.
#include "identification/contradiction.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "base/random.hpp"
#include "identification/auto_identify.hpp"
#include "identification/identify_fixture.hpp"

namespace fpc {
namespace fuzzy_contradiction_test {

using Eigen::Index;

/// y(k+1) = 0.8 y + 0.3 u - 0.2 v, measured with noise: gains 1.5 and -1, pole 0.8.
DataSet record(Index rows, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  DataSet data;
  data.source = "simulated";
  data.sample_time_s = 1.0;
  data.values.resize(rows, 3);
  double y = 0.0, u = 0.0, v = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 5 == 0) u = 2.0 * uniform(random) - 1.0;
    if (k % 7 == 0) v = 2.0 * uniform(random) - 1.0;
    data.values.row(k) << y + noise * standardNormal(random), u, v;
    y = 0.8 * y + 0.3 * u - 0.2 * v;
  }
  const auto info = [&](const char* name, Index c) {
    return SignalInfo{name, "", data.values.col(c).minCoeff(), data.values.col(c).maxCoeff()};
  };
  data.outputs = {info("y", 0)};
  data.inputs = {info("u", 1)};
  data.disturbances = {info("v", 2)};
  data.constant.assign(3, false);
  return data;
}

PriorKnowledge signs(int u, int v) {
  PriorKnowledge known;
  known.gain = {u, v};
  return known;
}

std::string wordsOf(const DataSet& data, const PriorKnowledge& known) {
  return contradiction(
      data, 0,
      {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}, {SignalKind::kDisturbance, 0, 0}},
      known);
}

/// Expects the words of these statements and figures, the second far below the first.
void expectBlame(const std::string& words, const std::string& statements) {
  const std::string begin = "the record contradicts " + statements + ": ";
  ASSERT_EQ(words.rfind(begin, 0), 0U) << words;
  double with = 0.0, without = 0.0;
  ASSERT_EQ(std::sscanf(words.c_str() + begin.size(),
                        "free run over held-out blocks %lf with it, %lf without", &with, &without),
            2)
      << words;
  EXPECT_LT(without, 0.5 * with) << words;
}

TEST(Contradiction, TheRightSignsAreNotDoubted) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const double noise : {0.02, 0.3}) {
      PriorKnowledge known = signs(1, -1);
      known.max_pole = 0.95;
      known.steady = {{(Vector(3) << 1.5, 1.0, 0.0).finished(), 0.3}};
      EXPECT_EQ(wordsOf(record(160, noise, seed), known), "") << seed << " " << noise;
    }
}

TEST(Contradiction, AWrongSignIsNamedWithBothErrors) {
  const DataSet data = record(160, 0.02, 1);
  expectBlame(wordsOf(data, signs(-1, -1)), "known.gain of u (negative)");
  expectBlame(wordsOf(data, signs(1, 1)), "known.gain of v (positive)");
  expectBlame(wordsOf(data, signs(-1, 0)), "known.gain of u (negative)");
  PriorKnowledge monotone;
  monotone.monotone = {0, 1};
  expectBlame(wordsOf(data, monotone), "known.monotone of v (positive)");
  EXPECT_NE(wordsOf(data, signs(-1, 1)).find(" and "), std::string::npos);
}

TEST(Contradiction, AWrongPoleOrRestIsNamed) {
  const DataSet data = record(160, 0.02, 2);
  PriorKnowledge known = signs(1, -1);
  known.max_pole = 0.3;
  expectBlame(wordsOf(data, known), "known.max_pole (0.3)");
  known.max_pole = 0.9;
  known.steady = {{(Vector(3) << 1.5, 1.0, 0.0).finished(), 0.1},
                  {(Vector(3) << 4.0, 1.0, 0.0).finished(), 0.1}};
  const std::string words = wordsOf(data, known);
  EXPECT_NE(words.find("known.steady (number 2)"), std::string::npos) << words;
  EXPECT_EQ(words.find("known.gain"), std::string::npos) << words;
}

TEST(Contradiction, NoiseSpeaksAgainstNothing) {
  DataSet data = record(160, 0.02, 3);
  std::mt19937_64 random(4);
  for (Index k = 0; k < data.rows(); ++k) data.values(k, 0) = standardNormal(random);
  EXPECT_EQ(wordsOf(data, signs(1, -1)), "");
  EXPECT_EQ(wordsOf(data, signs(-1, 1)), "");
}

TEST(Contradiction, TheSearchSaysItForTheOutputAndObeysAllTheSame) {
  AutoParams params;
  params.budget_s = 300.0;
  params.states = false;
  params.known = {signs(1, 1)};
  const AutoIdentification found = autoIdentify(record(160, 0.02, 1), params);
  ASSERT_EQ(found.contradictions.size(), 1U);
  EXPECT_EQ(found.contradictions[0].rfind("y: the record contradicts known.gain of v", 0), 0U);
  params.known = {signs(1, -1)};
  EXPECT_TRUE(autoIdentify(record(160, 0.02, 1), params).contradictions.empty());
}

TEST(Contradiction, IsTheFirstRemarkOfAStructureToo) {
  const Structure structure = test::knownStructure();
  const DataSet data = makeDataSet(test::knownRecord(200, 3, 0.05), structure, "record");
  const auto remarks = [&](int sign) {
    PriorKnowledge known;
    known.gain = {sign};
    return identify(data, structure, {}, {known}).remarks;
  };
  ASSERT_FALSE(remarks(-1).empty());
  EXPECT_EQ(remarks(-1)[0].rfind("y: the record contradicts known.gain of u (negative)", 0), 0U)
      << remarks(-1)[0];
  for (const auto& remark : remarks(1))
    EXPECT_EQ(remark.find("contradicts"), std::string::npos) << remark;
}

}  // namespace fuzzy_contradiction_test
}  // namespace fpc
