// What is known of a process holds in every fit.
#include "identification/prior_knowledge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "identification/auto_identify.hpp"
#include "identification/identify_fixture.hpp"
#include "identification/prediction.hpp"
#include "identification/validation.hpp"

namespace fpc {
namespace fuzzy_prior_knowledge_test {

using Eigen::Index;

PriorKnowledge gainOf(int sign) {
  PriorKnowledge known;
  known.gain = {sign};
  return known;
}

/// Structure and statements on y.
struct Case {
  Structure structure;
  std::vector<PriorKnowledge> known;
};
Case caseOf(const std::string& body, const std::string& rest = "clusters: 3",
            const std::string& settings = "") {
  Case c{test::knownStructure(rest, settings), {}};
  c.known = readKnown("y: {" + body + "}", c.structure);
  return c;
}

Identification identified(const Case& c, const Matrix& values) {
  return identify(makeDataSet(values, c.structure, "record"), c.structure, {}, c.known);
}

/// From a short, loud record.
Identification identified(const std::string& body, std::uint64_t seed,
                          const std::string& settings = "") {
  return identified(caseOf(body, "clusters: 3", settings), test::knownRecord(60, seed, 0.4));
}

double lowestGain(const TsModel& model, double sign) {
  double lowest = 1e9;
  for (const auto& rule : ruleDynamics(model)) lowest = std::min(lowest, sign * rule.gains.at(0));
  return lowest;
}

TEST(PriorKnowledge, NearestPointIsThatOnPaper) {
  // min (x - 1)^2 + 4 (y - 1)^2 subject to x + y <= 1: x = 0.2, y = 0.8
  const KnowledgeRows rows{Matrix::Ones(1, 2), Vector::Constant(1, -1e9), Vector::Ones(1)};
  Matrix H = Matrix::Zero(2, 2);
  H.diagonal() << 1.0, 4.0;
  Vector theta = Vector::Ones(2);
  ASSERT_TRUE(nearestInside(rows, H, theta));
  EXPECT_NEAR(theta[0], 0.2, 1e-6);
  EXPECT_NEAR(theta[1], 0.8, 1e-6);
  const KnowledgeRows none{Matrix::Ones(2, 2), (Vector(2) << -1e9, 2.0).finished(),
                           (Vector(2) << 1.0, 1e9).finished()};
  EXPECT_FALSE(nearestInside(none, H, theta));
}

TEST(PriorKnowledge, NoGainOfTheWrongSignIsLeft) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    wrong += lowestGain(identified("", seed).model, 1.0) <= 0.0;
    for (const char* settings :
         {"consequents: {method: local}", "consequents: {method: global}",
          "consequents: {method: recursive}", "consequents: {free_run_iterations: 10}"})
      EXPECT_GT(lowestGain(identified("gain: {u: positive}", seed, settings).model, 1.0), 0.0)
          << seed << " " << settings;
  }
  EXPECT_GT(wrong, 0) << "this record does not need the knowledge";
}

TEST(PriorKnowledge, ASignAgainstTheDataHoldsToo) {
  EXPECT_GT(lowestGain(identified("gain: {u: negative}", 3).model, -1.0), 0.0);
}

TEST(PriorKnowledge, WhatTheDataSayAnywayChangesNothing) {
  const std::string grid = "partition: {method: grid}";
  const Case without = caseOf("", test::kKnownGrid, grid);
  const Case with = caseOf("gain: {u: positive}, max_pole: 0.99", test::kKnownGrid, grid);
  const Matrix values = test::knownRecord(600, 4);
  const auto free = identified(without, values), bound = identified(with, values);
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_EQ(free.model.submodels[0].rules[r].coefficients,
              bound.model.submodels[0].rules[r].coefficients);
}

TEST(PriorKnowledge, PolesStayInsideTheirRadius) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto found = identified("max_pole: 0.5", seed);
    for (const auto& rule : ruleDynamics(found.model))
      EXPECT_LE(std::abs(rule.poles.at(0)), 0.5) << seed;
  }
}

TEST(PriorKnowledge, PolesOfHighOrderAreShrunk) {
  Case c = caseOf("max_pole: 0.6", "clusters: 2");
  c.structure.submodels[0].regressors = {{SignalKind::kOutput, 0, 0},
                                         {SignalKind::kOutput, 0, 1},
                                         {SignalKind::kOutput, 0, 2},
                                         {SignalKind::kInput, 0, 0}};
  const Matrix values = test::knownRecord(200, 2, 0.1);
  for (const auto& rule : ruleDynamics(identified(c, values).model))
    EXPECT_LE(std::abs(rule.poles.at(0)), 0.6);
}

TEST(PriorKnowledge, ASteadyStateIsMet) {
  // the true process rests at y = 0.525.. for u = 0; say it rests elsewhere
  const auto found = identified("steady: [{u: 0, y: -1.5, within: 0.1}]", 5);
  DataSet rest = makeDataSet(test::knownRecord(400, 1), test::knownStructure(), "rest");
  rest.values.col(1).setZero();
  rest.values.col(0).setConstant(-1.5);
  EXPECT_NEAR(predictFreeRun(found.model, rest)(399, 0), -1.5, 0.1);
}

TEST(PriorKnowledge, MonotoneMeansTheBlendedModelToo) {
  const Case c = caseOf("monotone: {u: positive}");
  int broken = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Matrix values = test::knownRecord(60, seed, 0.4);
    const DataSet data = makeDataSet(values, c.structure, "record");
    const auto breaks = [&](const Identification& found) {
      return !brokenKnowledge(found.model.submodels[0], 0, data, c.known[0]).empty();
    };
    broken += breaks(identified(caseOf(""), values)) ? 1 : 0;
    EXPECT_FALSE(breaks(identified(c, values))) << seed;
  }
  EXPECT_GT(broken, 0);
}

TEST(PriorKnowledge, StatementsThatContradictAreRefused) {
  EXPECT_THROW(identified("gain: {u: positive}, steady: [{u: -1, y: 1, within: 0.001}, "
                          "{u: 1, y: -1, within: 0.001}, {u: 0, y: 5, within: 0.001}, "
                          "{u: 0, y: -5, within: 0.001}]",
                          1),
               InputError);
  EXPECT_THROW(identified("gain: {v: positive}", 1), InputError);
  EXPECT_THROW(identified("gain: {u: up}", 1), InputError);
  EXPECT_THROW(identified("max_pole: 1.5", 1), InputError);
  EXPECT_THROW(identified("steady: [{y: 1, within: 1}]", 1), InputError);
}

TEST(PriorKnowledge, AutoKeepsItInEveryKind) {
  const Structure structure = test::knownStructure();
  const DataSet data = makeDataSet(test::knownRecord(90, 3, 0.5), structure, "record");
  AutoParams params;
  params.budget_s = 300.0;
  params.states = false;
  params.known = {gainOf(-1)};
  params.known[0].max_pole = 0.9;
  const AutoIdentification found = autoIdentify(data, params);
  for (const auto* model : {&found.model, &found.linear}) {
    EXPECT_GT(lowestGain(*model, -1.0), 0.0);
    for (const auto& rule : ruleDynamics(*model)) EXPECT_LE(std::abs(rule.poles.at(0)), 0.9);
  }
  params.known = {gainOf(1), gainOf(1)};
  EXPECT_THROW(autoIdentify(data, params), InputError);
}

TEST(PriorKnowledge, IsReadFromTextOrFile) {
  const Structure structure = test::knownStructure();
  const auto known = readKnown("y: {gain: {u: negative}, max_pole: 0.9}", structure);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].gain, std::vector<int>{-1});
  EXPECT_EQ(known[0].max_pole, 0.9);
  EXPECT_TRUE(readKnown("y: {}", structure)[0].empty());
  EXPECT_THROW(readKnown("z: {max_pole: 0.9}", structure), InputError);
  EXPECT_THROW(readKnown("no_such_file.yaml", structure), InputError);
}

TEST(PriorKnowledge, AWrongNameIsToldTheRightOnes) {
  try {
    readKnown("y: {gain: {v: positive}}", test::knownStructure());
    FAIL() << "v is no signal";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--known:1: y.gain.v: unknown key; expected one of u");
  }
}

TEST(PriorKnowledge, StandsInStructureFilesForThoseWhoKeepIt) {
  const std::string text =
      "name: t\nsample_time_s: 1\noutputs: {y: {}}\ninputs: {u: {}}\nsubmodels:\n  y:\n"
      "    regressors: [y(k), u(k)]\n    known: {monotone: {u: positive}}\n";
  std::vector<PriorKnowledge> known;
  parseStructure(text, "t.yaml", &known);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].monotone, std::vector<int>{1});
  EXPECT_THROW(parseStructure(text, "t.yaml"), InputError);
}

}  // namespace fuzzy_prior_knowledge_test
}  // namespace fpc
