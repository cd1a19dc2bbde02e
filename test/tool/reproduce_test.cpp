// The table of experiments: every table and figure with results in the papers has an entry, every
// figure a picture, and what fails says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "papers/expression.hpp"
#include "papers/perturbations.hpp"
#include "papers/picture.hpp"
#include "papers/report.hpp"
#include "papers/runs.hpp"
#include "papers/sludge_printed.hpp"
#include "tool/rows.hpp"

namespace fpc::papers {
namespace tool_reproduce_test {

std::vector<std::string> figures(int from, int to) {
  std::vector<std::string> all;
  for (int i = from; i <= to; ++i) all.push_back("figure " + std::to_string(i));
  return all;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Read in the papers: every table and figure that shows a result, not a diagram or a definition.
std::map<std::string, std::vector<std::string>> withResults() {
  std::map<std::string, std::vector<std::string>> all{
      {"blazic2007", {"table 1", "figure 1", "figure 2", "figure 3"}},
      {"vallejo2019", {"table 5", "table 6", "table 7", "table 8", "table 11"}},
      {"vallejo2021a",
       {"table 3", "table 4", "table 5", "table 6", "table 7", "table 8", "table A1", "table A2"}},
      {"vallejo2021b", {"table 1", "figure 4", "figure 5"}},
      {"karer2007", {}},
      {"mekki", {"table 1", "table 2", "table 3", "table 4", "table 5"}},
      {"taieb2017", {"table 1", "table 3", "table 5", "table 6"}}};
  append(all["vallejo2019"], figures(4, 10));
  append(all["vallejo2019"], figures(13, 28));
  append(all["vallejo2021a"], figures(5, 11));
  append(all["karer2007"], figures(3, 14));
  append(all["mekki"], figures(6, 8));
  append(all["taieb2017"], figures(4, 10));
  return all;
}

TEST(Experiments, CoverEveryTableAndFigureWithResults) {
  std::size_t count = 0;
  for (const auto& [paper, items] : withResults())
    for (const auto& item : items) {
      const auto all = experiments();
      EXPECT_EQ(std::count_if(all.begin(), all.end(),
                              [&, key = paper](const Experiment& e) {
                                return e.paper == key && e.item == item;
                              }),
                1)
          << paper << ", " << item;
      ++count;
    }
  EXPECT_EQ(count, 81U);
  const auto all = experiments();
  EXPECT_EQ(std::count_if(all.begin(), all.end(), isTableOrFigure), 81);
}

TEST(Experiments, SayWhatTheyShowAndWhatIsBehindThem) {
  std::set<std::string> names;
  for (const auto& e : experiments()) {
    EXPECT_TRUE(names.insert(e.name).second) << e.name << " twice";
    for (const std::string& text : {e.shows, e.printed, e.behind})
      EXPECT_FALSE(text.empty()) << e.name;
  }
}

TEST(Experiments, OfFiguresHaveAPicture) {
  for (const auto& e : experiments())
    if (e.item.rfind("figure", 0) == 0) EXPECT_TRUE(hasPicture(e)) << e.name;
}

TEST(Experiments, AreInTheOrderOfThePapersAndTheirNumbers) {
  std::vector<std::string> items;
  for (const auto& e : experiments())
    if (e.paper == "taieb2017" && e.item.rfind("figure", 0) == 0) items.push_back(e.item);
  EXPECT_EQ(items, figures(4, 10));
}

const char kPaper[] = R"(
title: a paper
experiments:
  - name: one
    item: table 1
    shows: something
    printed: 2 numbers
    behind: nothing
    each: {unit: m}
    rows:
      - over: {n: [1, 2], printed: [4, 0.5 * 10]}
        rows:
          - {of: "height {n}", paper: "{printed}", here: "2 * {n} + 2", note: "half is {}", note_value: "{n} + 1"}
      - {of: deviation, at_most: 25, here: deviation, unit: "%"}
)";

TEST(PaperFile, RowsAreWrittenOnceForListsOfWords) {
  const auto all = experimentsIn(kPaper, "paper");
  ASSERT_EQ(all.size(), 1U);
  const Rows rows = rowsOf(all[0]);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].quantity, "height 1");
  EXPECT_EQ(rows[0].verdict(), Verdict::kReproduced);
  EXPECT_EQ(rows[1].paper, 5.0);
  EXPECT_EQ(rows[1].here.median(), 6.0);
  EXPECT_EQ(rows[1].note, "half is 3");
  EXPECT_EQ(rows[1].unit, "m");
  EXPECT_EQ(rows[1].behind, "nothing");
  EXPECT_NEAR(rows[2].here.median(), 10.0, 1e-12) << "of 0 and 20 %";
}

/// The file with one text in place of another is refused with these words.
void expectRefused(const std::string& what, const std::string& by, const std::string& words) {
  std::string text = kPaper;
  const auto at = text.find(what);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, what.size(), by);
  try {
    experimentsIn(text, "paper.yaml");
    ADD_FAILURE() << by;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(PaperFile, MistakesAreNamed) {
  expectRefused("printed: [4, 0.5 * 10]", "printed: [4]", "one.over.printed");
  expectRefused("at_most: 25", "verdict: holds", "verdict");
  expectRefused("at_most: 25, ", "", "paper");
  expectRefused("here: deviation", "here: unheard", "unheard");
  expectRefused("here: deviation", "here: \"ise(asp_case1)\"", "2 arguments");
  expectRefused("here: deviation", "here: \"1 +\"", "a number, a name");
  expectRefused("here: deviation, ", "", "here");
}

TEST(PaperFile, WhatCannotBeComputedIsARowWithoutAResultThatSaysWhy) {
  std::string text = kPaper;
  text.replace(text.find("here: deviation"), 15, "here: \"ise(no_such_loop, x)\"");
  const Rows rows = rowsOf(experimentsIn(text, "paper")[0]);
  EXPECT_EQ(rows[1].verdict(), Verdict::kNotReproduced);
  EXPECT_EQ(rows[2].verdict(), Verdict::kNoResult);
  EXPECT_NE(rows[2].note.find("no_such_loop"), std::string::npos) << rows[2].note;
}

TEST(Expression, GoesWithValuesOfSeveralRunsRunByRun) {
  registerComputation("pair", 2, [](const Words& w) {
    return Values(std::vector<double>{std::stod(w[0]), std::stod(w[1])});
  });
  EXPECT_EQ(evaluate("1 + 2 * 3 - 4 / 2").median(), 5.0);
  EXPECT_EQ(evaluate("-(1 - 1.5e1)").median(), 14.0);
  EXPECT_EQ(evaluate("pair(1, 5) - pair(2, 3)").all(), (std::vector<double>{-1.0, 2.0}));
  EXPECT_EQ(evaluate("100 * (1 - pair(1, 5))").all(), (std::vector<double>{0.0, -400.0}));
  EXPECT_EQ(evaluate("mean(pair(1, 5))").all(), (std::vector<double>{3.0}));
  EXPECT_EQ(evaluate("highest(abs(pair(-7, 5)))").median(), 7.0);
  EXPECT_EQ(evaluate("distance(pair(2, 3), 5)").median(), 2.0);
  EXPECT_EQ(evaluate("distance(pair(2, 3), 2.5)").median(), 0.0);
  EXPECT_EQ(evaluate("max(pair(1, 5), 3)").all(), (std::vector<double>{3.0, 5.0}));
  for (const char* wrong : {"", "1 1", "2 *", "(1", "f(2)", "pair(1)", "x", "abs(1, 2)", "1 +* 2"})
    EXPECT_THROW(evaluate(wrong), InputError) << wrong;
}

TEST(Runs, ThatFailThrowEachTimeAndNameWhatIsUnknown) {
  const Overrides wrong{{"sampling.sample_time_s", "-1"}};
  for (int i = 0; i < 2; ++i) EXPECT_THROW(recordOf("linear_2x2", wrong), InputError) << i;
  const Overrides frozen{{"plant.integrator.max_steps", "1"}, {"sampling.duration_h", "2"}};
  for (int i = 0; i < 2; ++i) EXPECT_THROW(recordOf("asp_case1_pi_x", frozen), InputError) << i;
  EXPECT_THROW(recordOf("linear_2x2+no_setting"), InputError);
  EXPECT_THROW(recordOf("batch_fuzzy_eq44+starts"), InputError) << "four runs, not one";
  EXPECT_THROW(evaluate("steps(linear_2x2, no_output, rise, 1)"), InputError);
}

TEST(Perturbations, ChangeTheLoopsThatTheyName) {
  const std::vector<std::string> names = perturbationNames();
  ASSERT_GE(names.size(), 4U);
  EXPECT_THROW(perturb("nothing"), InputError);
  const auto rate = [] {
    const auto loop = loopOf("cstr_tracking");
    const auto at = loop.simulation.parameters.find("rate_constant");
    return at == loop.simulation.parameters.end() ? 7.2e10 : at->second;
  };
  const double before = rate();
  perturb("plant");
  const double after = rate();
  perturbEachLoop({});
  EXPECT_DOUBLE_EQ(after, 1.1 * before);
  EXPECT_EQ(rate(), before);
}

TEST(Report, CountsFiguresAndStatementsApart) {
  const Rows rows{figure("a", 1.0, 1.0, "-"), figure("b", 1.0, 2.0, "-"),
                  check("c", 0.5, Direction::kLower, 1.0, "-", "")};
  EXPECT_EQ(inWords(countsOf(rows)), "1 reproduced, 1 not reproduced, 1 holds");
  EXPECT_NE(reasonOf(rows).find("b: 100 % off"), std::string::npos) << reasonOf(rows);
}

TEST(Report, TellsAStatementsNumberFromItsLimitHoweverNearTheyAre) {
  const auto shown = [](double here, Direction side) {
    return hereText(check("c", here, side, 1.0, "-", ""));
  };
  EXPECT_EQ(shown(1.0000095, Direction::kLower), "1.00001");
  EXPECT_EQ(shown(0.99996, Direction::kHigher), "0.99996");
  EXPECT_EQ(shown(0.99996, Direction::kLower), "1") << "it holds: nothing is hidden";
  EXPECT_EQ(shown(0.5, Direction::kLower), "0.5");
  EXPECT_EQ(shown(1.0, Direction::kLower), "1");
  EXPECT_EQ(hereText(figure("f", 1.0, 1.0000095, "-")), "1") << "figures are judged by a tolerance";
}

TEST(Report, NamesFailedRunsEvenWhereNoRowIsJudged) {
  const std::vector<double> seeds{1.0, std::nan("")};
  const std::vector<Outcome> judged_not{{{}, {incomparable("ISE", 1.0, seeds, "-", "other data")}}};
  EXPECT_TRUE(failuresOf(judged_not, {}).empty());
  EXPECT_EQ(failuresOf(judged_not, {"asp_case1, seed 2: why"}),
            std::vector<std::string>{"failed: asp_case1, seed 2: why"});
  const std::vector<Outcome> lost{{{}, {check("c", seeds, Direction::kLower, 2.0, "-", "")}}};
  EXPECT_EQ(failuresOf(lost, {}), std::vector<std::string>{"1 rows without a result"});
}

Experiment named(const std::string& name) {
  for (const Experiment& e : experiments())
    if (e.name == name) return e;
  throw InputError(name + ": expected an experiment");
}

TEST(Pictures, CloseUpsShowTheirPartOnly) {
  const Panel panel =
      closeUp({"T", {{"a", {0.0, 1.0, 2.0, 3.0}, {5.0, 6.0, 7.0, 8.0}}}}, {1.0, 2.5});
  EXPECT_EQ(panel.curves[0].x, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(panel.curves[0].y, (std::vector<double>{6.0, 7.0}));
  const auto json = toJson(Picture{"time [s]", {panel, {"T", {}, {{"printed", 4.0}}}}});
  EXPECT_EQ(json["panels"][0]["from"], 1.0);
  EXPECT_TRUE(json["panels"][1]["from"].is_null());
  EXPECT_TRUE(json["panels"][1]["marks"][0]["x"].is_null());
}

TEST(Pictures, OfTheThreeTemperaturesAreOfThreeParts) {
  std::set<double> from;
  for (const char* figure : {"batch_figure_12", "batch_figure_13", "batch_figure_14"})
    from.insert(pictureOf(named(figure)).panels.at(1).span.from);
  EXPECT_EQ(from.size(), 3U);
}

TEST(Pictures, OfTheColumnShowTheChangedGains) {
  const Picture picture = pictureOf(named("column_figure_8"));
  const auto& curves = picture.panels.at(1).curves;  // setpoint, reference, three gains
  ASSERT_EQ(curves.size(), 5U);
  for (const std::size_t i : {3U, 4U}) {
    double most = 0.0;
    for (std::size_t k = 0; k < curves[i].y.size(); ++k)
      most = std::max(most, std::abs(curves[i].y[k] - curves[2].y[k]));
    EXPECT_GT(most, 0.01) << curves[i].label;  // mol%
  }
  EXPECT_EQ(picture.panels[1].marks.size(), 1U);
}

TEST(PrintedModels, HaveTheNumbersOfTheirTables) {
  for (const auto& [model, coefficients, sets] :
       {std::tuple{1, 62U, 51U}, std::tuple{2, 51U, 40U}}) {
    std::size_t count = 0;
    for (const auto& rule : printedConsequents(model)) count += rule.size();
    EXPECT_EQ(count, coefficients);
    EXPECT_EQ(printedSets(model).size(), sets);
    for (const auto& set : printedSets(model)) EXPECT_EQ(set.size(), 4U);
  }
}

TEST(PrintedModels, AreHeldAgainstAFileNumberByNumber) {
  auto held = printedConsequents(1);
  EXPECT_EQ(unlike(printedConsequents(1), held), 0.0);
  held[3][2] *= 1.001;
  EXPECT_EQ(unlike(printedConsequents(1), held), 1.0);
  held[0].pop_back();
  EXPECT_EQ(unlike(printedConsequents(1), held), 8.0) << "a row of seven is lost";
  EXPECT_EQ(unlike(printedConsequents(1), {}), 62.0);
}

TEST(Report, HasNoMinusZeroAndAMarkForNoNumber) {
  EXPECT_EQ(shortText(-0.0), "0");
  EXPECT_EQ(shortText(std::nan("")), "-");
  EXPECT_EQ(shortText(-51653.6597), "-5.165e+04");
}

TEST(Report, MarkdownHasARowForEachAndKeepsItsColumns) {
  Experiment e;
  e.paper = "mekki";
  e.item = "table 9";
  const std::string page = markdown({{e, {figure("|m|", 1.0, 1.0, "-")}}});
  EXPECT_NE(page.find("\\|m\\|"), std::string::npos);
  EXPECT_NE(page.find("| table 9 |"), std::string::npos);
}

}  // namespace tool_reproduce_test
}  // namespace fpc::papers
