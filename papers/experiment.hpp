// The experiments of `fmbpc reproduce`: every table and figure with results in the papers, one
// entry each, as papers/KEY.yaml lists them with the expression that computes each number.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "papers/values.hpp"
#include "papers/verdict.hpp"

namespace fpc::papers {

struct Row {
  std::string quantity;
  bool statement{false};
  double paper{kNotPrinted};  ///< printed figure, or the limit of a statement; NaN: none
  Values here{kNotPrinted};
  std::string unit{"-"};
  Tolerance tolerance{};
  Direction direction{Direction::kEqual};
  std::string incomparable;  ///< reason, empty: comparable
  bool observed{false};      ///< a statement that holds with every wrong plant and law
  std::string note;
  std::string behind;  ///< loops or command
  Verdict verdict() const { return verdictAt(here.median()); }
  Verdict verdictAt(double value) const;
  double agreeing() const;  ///< share of the runs that give the same verdict
};
using Rows = std::vector<Row>;

/// A row before it is computed.
struct PlannedRow {
  /// What must hold for the figure to be compared; else `otherwise` is the reason, {} in it the
  /// number found.
  struct Condition {
    std::string here;
    double at_least{-std::numeric_limits<double>::infinity()};
    double at_most{std::numeric_limits<double>::infinity()};
    std::string otherwise;
  };
  Row row;
  std::string here;        ///< expression: papers/expression.hpp
  std::string note_value;  ///< expression of what stands for {} in the note
  std::optional<Condition> only_if;
};

/// Runs over time that stand for a figure.
struct RunPicture {
  std::vector<std::string> runs, signals;
};

struct Experiment {
  std::string name;     ///< "cstr_figure_2"
  std::string paper;    ///< key of papers()
  std::string item;     ///< "figure 2"; "beyond the paper": ours
  std::string shows;    ///< in a few words
  std::string printed;  ///< figures it prints: "4 numbers", "curves"
  std::string behind;   ///< loops or command
  std::optional<RunPicture> picture;
  std::vector<PlannedRow> rows;
};

struct Paper {
  std::string key, title;
};

const std::vector<Paper>& papers();  ///< in the order of the page
/// As the files list them. @throws InputError naming file, place and key of what is wrong.
const std::vector<Experiment>& experiments();
/// Those of one text in the form of papers/KEY.yaml; for tests.
std::vector<Experiment> experimentsIn(const std::string& text, const std::string& key);
/// Computed. What cannot be has no result and says why.
Rows rowsOf(const Experiment& experiment);
/// A numbered table or figure of a paper, not an equation, a section or an addition of ours.
bool isTableOrFigure(const Experiment& experiment);

}  // namespace fpc::papers
