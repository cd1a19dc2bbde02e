// The one function that turns a printed figure and ours into a verdict, and that nothing else does.
#include "papers/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>

#include "fmbpc/base/input_error.hpp"
#include "papers/experiment.hpp"
#include "papers/expression.hpp"
#include "paths.hpp"
#include "tool/rows.hpp"

namespace fpc::papers {
namespace tool_verdict_test {

Claim figureOf(double paper, double here, Direction better = Direction::kEqual,
               double absolute = 0.0) {
  return {false, paper, here, {0.01, 0.1, absolute}, better, true};
}

Claim statementOf(double limit, double here, Direction side, double absolute = 0.0) {
  return {true, limit, here, {0.01, 0.1, absolute}, side, true};
}

TEST(Verdict, OfAFigureFollowsItsDistanceFromThePrintedOne) {
  EXPECT_EQ(verdictOf(figureOf(100.0, 100.9)), Verdict::kReproduced);
  EXPECT_EQ(verdictOf(figureOf(100.0, 99.1)), Verdict::kReproduced);
  EXPECT_EQ(verdictOf(figureOf(100.0, 101.1)), Verdict::kClose);
  EXPECT_EQ(verdictOf(figureOf(100.0, 90.1)), Verdict::kClose);
  EXPECT_EQ(verdictOf(figureOf(100.0, 111.0)), Verdict::kNotReproduced);
  EXPECT_EQ(verdictOf(figureOf(100.0, -100.0)), Verdict::kNotReproduced) << "the sign counts";
  EXPECT_EQ(verdictOf(figureOf(-2.0, -2.01)), Verdict::kReproduced);
}

TEST(Verdict, IsBetterOnlyOnTheBetterSideAndBeyondReproduced) {
  EXPECT_EQ(verdictOf(figureOf(100.0, 95.0, Direction::kLower)), Verdict::kBetter);
  EXPECT_EQ(verdictOf(figureOf(100.0, 10.0, Direction::kLower)), Verdict::kBetter);
  EXPECT_EQ(verdictOf(figureOf(100.0, 99.5, Direction::kLower)), Verdict::kReproduced);
  EXPECT_EQ(verdictOf(figureOf(100.0, 105.0, Direction::kLower)), Verdict::kClose);
  EXPECT_EQ(verdictOf(figureOf(100.0, 150.0, Direction::kLower)), Verdict::kNotReproduced);
  EXPECT_EQ(verdictOf(figureOf(100.0, 150.0, Direction::kHigher)), Verdict::kBetter);
  EXPECT_EQ(verdictOf(figureOf(100.0, 50.0, Direction::kHigher)), Verdict::kNotReproduced);
}

TEST(Verdict, OfAPrintedZeroNeedsAnAbsoluteTolerance) {
  EXPECT_EQ(verdictOf(figureOf(0.0, 1e-9)), Verdict::kNotReproduced);
  EXPECT_EQ(verdictOf(figureOf(0.0, 0.0)), Verdict::kReproduced);
  EXPECT_EQ(verdictOf(figureOf(0.0, 0.004, Direction::kEqual, 0.005)), Verdict::kReproduced);
  EXPECT_EQ(verdictOf(figureOf(0.0, 0.006, Direction::kEqual, 0.005)), Verdict::kNotReproduced);
}

TEST(Verdict, OfAStatementHoldsOrFails) {
  EXPECT_EQ(verdictOf(statementOf(1.0, 0.99, Direction::kLower)), Verdict::kHolds);
  EXPECT_EQ(verdictOf(statementOf(1.0, 1.001, Direction::kLower)), Verdict::kFails);
  EXPECT_EQ(verdictOf(statementOf(1.0, 1.001, Direction::kHigher)), Verdict::kHolds);
  EXPECT_EQ(verdictOf(statementOf(1.0, 0.9, Direction::kHigher)), Verdict::kFails);
  EXPECT_EQ(verdictOf(statementOf(1.0, 1.1, Direction::kEqual, 0.15)), Verdict::kHolds);
  EXPECT_EQ(verdictOf(statementOf(1.0, 1.2, Direction::kEqual, 0.15)), Verdict::kFails);
}

TEST(Verdict, WithoutANumberIsNoResultAndWithAReasonNotComparable) {
  EXPECT_EQ(verdictOf(figureOf(1.0, std::nan(""))), Verdict::kNoResult);
  EXPECT_EQ(verdictOf(figureOf(std::nan(""), 1.0)), Verdict::kNoResult);
  EXPECT_EQ(verdictOf(statementOf(1.0, INFINITY, Direction::kHigher)), Verdict::kNoResult);
  Claim claim = figureOf(1.0, 1.0);
  claim.comparable = false;
  EXPECT_EQ(verdictOf(claim), Verdict::kNotComparable);
}

TEST(Verdict, GetsNoWorseAsAFigureComesNearer) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> number(-10.0, 10.0), share(0.0, 1.0);
  const auto rank = [](const Claim& claim) { return static_cast<int>(verdictOf(claim)); };
  const int close = static_cast<int>(Verdict::kClose);
  for (int i = 0; i < 2000; ++i) {
    const double paper = number(generator), here = number(generator);
    const double nearer = paper + share(generator) * (here - paper);
    const int far = rank(figureOf(paper, here)), near = rank(figureOf(paper, nearer));
    EXPECT_LE(near, far) << paper << ", " << here << ", " << nearer;
    if (far <= close) EXPECT_LE(near, close);
    // the same figures in other units are judged alike
    EXPECT_EQ(rank(figureOf(1e3 * paper, 1e3 * here)), far) << paper << ", " << here;
  }
}

TEST(Row, OverSeedsIsJudgedByItsMedianAndCountsWhoAgrees) {
  const Row row =
      check("ratio", std::vector<double>{0.5, 0.7, 0.9, 1.2}, Direction::kLower, 1.0, "-", "");
  EXPECT_DOUBLE_EQ(row.here.median(), 0.8);
  EXPECT_EQ(row.verdict(), Verdict::kHolds);
  EXPECT_DOUBLE_EQ(row.agreeing(), 0.75);
}

TEST(Row, WithOneFailedRunHasNoResult) {
  const Row row =
      check("ratio", std::vector<double>{0.5, std::nan(""), 0.9}, Direction::kLower, 1.0, "-", "");
  EXPECT_EQ(row.verdict(), Verdict::kNoResult);
}

TEST(Row, WithOneFailedRunHasNoRangeEither) {
  const Values some(std::vector<double>{0.5, std::nan(""), 0.9}), none(std::vector<double>{});
  for (const Values& values : {some, none}) {
    EXPECT_TRUE(std::isnan(values.lowest()));
    EXPECT_TRUE(std::isnan(values.highest()));
  }
  EXPECT_DOUBLE_EQ(Values(std::vector<double>{0.5, -1.0}).lowest(), -1.0);
  EXPECT_DOUBLE_EQ(Values(std::vector<double>{0.5, -1.0}).highest(), 0.5);
}

TEST(Row, ThatIsOnlyObservedCanFailAndCannotHold) {
  Row row = check("ratio", 0.5, Direction::kLower, 1.0, "-", "");
  row.observed = true;
  EXPECT_EQ(row.verdict(), Verdict::kObserved);
  row.here = 1.5;
  EXPECT_EQ(row.verdict(), Verdict::kFails);
  row.here = std::nan("");
  EXPECT_EQ(row.verdict(), Verdict::kNoResult) << "a run that failed is said all the same";
}

TEST(Row, ThatCannotBeComparedIsNotJudged) {
  EXPECT_EQ(incomparable("ISE", 1.0, 2.0, "-", "other data").verdict(), Verdict::kNotComparable);
}

// Verdicts may be asked for, never written down: beside verdict.cpp the word only follows == or !=.
TEST(Verdict, IsNoConstantAnywhere) {
  namespace fs = std::filesystem;
  const std::regex asked(R"([=!]=\s*Verdict::k)");
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(sourceDir() + "/papers")) {
    if (entry.path().filename().string().rfind("verdict.", 0) == 0) continue;
    if (entry.path().extension() == ".yaml")
      continue;  // has no verdicts: the reader refuses the key
    std::ifstream stream(entry.path());
    std::string line;
    for (int n = 1; std::getline(stream, line); ++n) {
      const std::string rest = std::regex_replace(line, asked, "");
      EXPECT_EQ(rest.find("Verdict::k"), std::string::npos)
          << entry.path().filename() << ":" << n << ": " << line;
    }
    ++files;
  }
  EXPECT_GT(files, 20U);
}

}  // namespace tool_verdict_test
}  // namespace fpc::papers
