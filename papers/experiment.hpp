// The table of experiments of `fmbpc reproduce`: every table and figure with results in the papers,
// one entry each, and the rows that stand for it. One file a system.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "papers/verdict.hpp"

namespace fpc::tool {

/// One figure, or the same of many runs (seeds): judged by the median, shown with the range.
class Values {
 public:
  Values(double value) : all_{value} {}                            // NOLINT: a number is one value
  Values(std::vector<double> values) : all_{std::move(values)} {}  // NOLINT
  std::size_t count() const { return all_.size(); }
  double median() const;  ///< NaN if there is none, or if one is not finite: a run failed
  double lowest() const;  ///< NaN as the median
  double highest() const;
  const std::vector<double>& all() const { return all_; }

 private:
  bool sound() const;  ///< at least one value, all finite
  std::vector<double> all_;
};

struct ReproduceRow {
  std::string quantity;
  bool statement{false};
  double paper{};  ///< printed figure, or the limit of a statement; NaN: none
  Values here{0.0};
  std::string unit;
  Tolerance tolerance{};
  Direction direction{Direction::kEqual};
  std::string incomparable;  ///< reason, empty: comparable
  std::string note;
  std::string behind;  ///< loops or command; empty: those of the experiment
  Verdict verdict() const;
  double agreeing() const;  ///< share of the runs that give the same verdict
};

using Rows = std::vector<ReproduceRow>;

/// How a figure is judged besides the 1 % of Tolerance.
struct Judged {
  double close{0.1};
  Direction better{Direction::kEqual};
  double absolute{0.0};
};

ReproduceRow figure(std::string quantity, double paper, Values here, std::string unit,
                    Judged judged = {}, std::string note = "");
/// A statement tested here: `here` at most (kLower) or at least (kHigher) `limit`; kEqual: within
/// `absolute` of it.
ReproduceRow check(std::string quantity, Values here, Direction side, double limit,
                   std::string unit, std::string note, double absolute = 0.0);
/// Ours beside what cannot be compared with it. `paper` NaN: it prints none.
ReproduceRow incomparable(std::string quantity, double paper, Values here, std::string unit,
                          std::string reason);
double notPrinted();

struct Experiment {
  std::string name;     ///< "cstr_figure_2"
  std::string paper;    ///< key of papers()
  std::string item;     ///< "figure 2"; "beyond the paper": ours
  std::string shows;    ///< in a few words
  std::string printed;  ///< figures it prints: "4 numbers", "curves"
  std::string behind;   ///< loops or command
  std::function<Rows()> rows;
};

struct Paper {
  std::string key, title;
};

const std::vector<Paper>& papers();
bool registerExperiments(std::vector<Experiment> some);
/// By paper, then by item, numbers in their order.
std::vector<Experiment> experiments();
/// Its rows with `behind` filled in. What throws becomes one row without a result.
Rows rowsOf(const Experiment& experiment);
/// A numbered table or figure of a paper, not an equation, a section or an addition of ours.
bool isTableOrFigure(const Experiment& experiment);

}  // namespace fpc::tool
