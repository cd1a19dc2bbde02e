#include "fmbpc/base/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_text_test {

TEST(Text, JoinPutsSeparatorsOnlyBetweenWords) {
  EXPECT_EQ(join({}), "");
  EXPECT_EQ(join({"a"}), "a");
  EXPECT_EQ(join({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(join({"", "b"}, "|"), "|b");
}

TEST(Text, ExactTextReadsBackToTheSameDouble) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 bits(kSeed);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::pow(10.0, exponent(bits)) * (i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(std::strtod(exactText(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(exactText(0.1), "0.1");
  EXPECT_EQ(exactText(2000.0), "2000");
  EXPECT_EQ(exactText(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(Text, NearestFindsSlipsOfTheFingersAndBeginnings) {
  const std::vector<std::string> known{"resolve", "run", "reproduce", "asp_case1", "asp_case1_clp"};
  EXPECT_EQ(nearest("rnu", known), std::vector<std::string>{"run"});
  EXPECT_EQ(nearest("reproduc", known).at(0), "reproduce");
  EXPECT_EQ(nearest("asp_caes1", known).at(0), "asp_case1");
  EXPECT_EQ(nearest("asp_c", known).size(), 2U);
  EXPECT_EQ(nearest("asp_case", known, 1).size(), 1U);
  EXPECT_TRUE(nearest("thermostat", known).empty());
  EXPECT_TRUE(nearest("", known).empty());
}

TEST(Text, NearestDoesNotMindCapitalsAndFindsParts) {
  const std::vector<std::string> known{"asp_case1", "asp_case1_clp", "blazic2007", "cstr_tracking"};
  EXPECT_EQ(nearest("ASP_CASE1", known).at(0), "asp_case1");
  EXPECT_EQ(nearest("case1_clp", known).at(0), "asp_case1_clp");
  EXPECT_EQ(nearest("Blazic", known), std::vector<std::string>{"blazic2007"});
  EXPECT_EQ(nearest("tracking", known), std::vector<std::string>{"cstr_tracking"});
  EXPECT_TRUE(nearest("as", known).empty()) << "two letters are in many words";
}

TEST(Text, LeftTablesHaveNoBlanksAtTheEndOfALine) {
  EXPECT_EQ(leftTable({{"a", "b"}, {"longer", "c"}}), "a       b\nlonger  c\n");
}

TEST(Text, EnvironmentVariablesAreReplacedInPlace) {
  setenv("FMBPC_TEXT_TEST", "folder", 1);
  EXPECT_EQ(expandEnvironment("a/${FMBPC_TEXT_TEST}/b/${FMBPC_TEXT_TEST}", "file"),
            "a/folder/b/folder");
  EXPECT_EQ(expandEnvironment("no variable, $5", "file"), "no variable, $5");
}

TEST(Text, AMissingVariableOrBraceIsNamed) {
  unsetenv("FMBPC_NOT_SET");
  try {
    expandEnvironment("${FMBPC_NOT_SET}/x.csv", "disturbance.file");
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("disturbance.file"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("FMBPC_NOT_SET"), std::string::npos) << e.what();
  }
  EXPECT_THROW(expandEnvironment("${HOME", "file"), InputError);
}

}  // namespace base_text_test
}  // namespace fpc
