// docs/results.md is what `fmbpc reproduce --markdown` prints: the same words, and numbers within
// one per cent, as another machine may round otherwise. Experiments of a second or less in every
// run; all of them with FMBPC_LONG_TESTS, which the stage `results` of .ci/run sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "paths.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_results_page_test {

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Equal, or numbers that agree within a per cent (or are both next to nothing).
bool alike(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  if (end_a == a.c_str() || end_b == b.c_str() || std::string(end_a) != end_b) return false;
  return std::abs(x - y) <= 1e-2 * std::max(std::abs(x), std::abs(y)) + 1e-9;
}

TEST(ResultsPage, ComparesNumbersByTheirSizeAndWordsByLetters) {
  EXPECT_TRUE(alike("0.4331", "0.4335"));
  EXPECT_TRUE(alike("1.054e-16,", "2e-17,"));
  EXPECT_FALSE(alike("0.43", "0.45"));
  EXPECT_FALSE(alike("close", "better"));
  EXPECT_FALSE(alike("3", "x"));
}

/// What the page has of the command.
std::string writtenPage() {
  std::ifstream stream(sourceDir() + "/docs/results.md");
  std::stringstream text;
  text << stream.rdbuf();
  const std::string page = text.str(), mark = "<!-- fmbpc reproduce --markdown -->\n";
  const auto at = page.find(mark);
  return at == std::string::npos ? "" : page.substr(at + mark.size());
}

/// Of the tables that have a row for each number; the words of each.
std::vector<std::vector<std::string>> rowsOf(const std::string& page) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream(page);
  for (std::string line; std::getline(stream, line);)
    if (std::count(line.begin(), line.end(), '|') >= 9 && line.find("---") == std::string::npos)
      rows.push_back(wordsOf(line));
  return rows;
}

bool alikeRow(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), alike);
}

TEST(ResultsPage, HasTheRowsOfQuickExperiments) {
  const auto written = rowsOf(writtenPage());
  const Outcome outcome = tool(
      "reproduce --markdown cstr asp1_table_0 asp1_figure_04 asp1_figure_05 asp1_figure_06 "
      "asp2_equations asp2_table_3 asp2_table_5 asp2_table_7 asp2_table_8 batch_figure_03 "
      "batch_figure_04 batch_figure_08 column_adaptation column_figure column_table_1 "
      "column_table_3 column_table_4 column_table_5 taieb_equation taieb_figure_4 taieb_figure_5 "
      "taieb_table_1 taieb_table_3 taieb_tank");
  EXPECT_EQ(outcome.code, 0);
  const auto printed = rowsOf(outcome.printed);
  EXPECT_GT(printed.size(), 250U);
  for (const auto& row : printed)
    EXPECT_TRUE(std::any_of(written.begin(), written.end(),
                            [&](const auto& other) { return alikeRow(row, other); }))
        << "not in docs/results.md (scripts/results_page writes it): "
        << ::testing::PrintToString(row);
}

TEST(ResultsPage, IsWhatTheCommandPrints) {
  if (!std::getenv("FMBPC_LONG_TESTS")) GTEST_SKIP() << "FMBPC_LONG_TESTS is not set";
  if (!std::getenv("FMBPC_DATA")) GTEST_SKIP() << "FMBPC_DATA is not set";
  const Outcome outcome = tool("reproduce --markdown");
  EXPECT_EQ(outcome.code, 0);
  const auto written = wordsOf(writtenPage()), printed = wordsOf(outcome.printed);
  ASSERT_EQ(written.size(), printed.size());
  for (std::size_t i = 0; i < written.size(); ++i)
    EXPECT_TRUE(alike(written[i], printed[i]))
        << "word " << i << ": " << written[i] << " / " << printed[i] << " after "
        << written[i > 0 ? i - 1 : 0];
}

// Beside the page: what the same command says on standard error.
TEST(ReproducePlots, OfASelectionWithoutFiguresDrawNothingAndWarnOfNothing) {
  const Outcome outcome =
      tool("reproduce cstr_propositions --plots " + ::testing::TempDir() + "/no_pictures", true);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.printed, "fmbpc: reproduce: blazic2007, from 1 of 1\n") << "progress alone";
}

}  // namespace tool_results_page_test
}  // namespace fpc
