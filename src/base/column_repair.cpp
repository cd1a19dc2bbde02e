#include "base/column_repair.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

enum class Fill { kNone, kDrop, kHold, kInterpolate };

Fill fillOf(MissingCells how) {
  if (how == MissingCells::kHold) return Fill::kHold;
  return how == MissingCells::kInterpolate ? Fill::kInterpolate : Fill::kDrop;
}

Fill fillOf(Implausible how) {
  if (how == Implausible::kHold) return Fill::kHold;
  return how == Implausible::kInterpolate ? Fill::kInterpolate : Fill::kDrop;
}

/// Decides what becomes of each cell; cells that are to be filled or dropped are NaN afterwards.
std::vector<Fill> judge(Eigen::Ref<Vector> cells, const ColumnRules& rules,
                        const std::function<std::string(Index)>& where, ColumnRepairs& repairs) {
  std::vector<Fill> fills(static_cast<std::size_t>(cells.size()), Fill::kNone);
  for (Index r = 0; r < cells.size(); ++r) {
    Fill& fill = fills[static_cast<std::size_t>(r)];
    double& cell = cells[r];
    if (std::isnan(cell)) {
      require(rules.missing != MissingCells::kError, where(r),
              "no missing cells; " + std::to_string(cells.array().isNaN().count()) +
                  " are, this is the first (" + rules.missing_key + " says what to do)");
      fill = fillOf(rules.missing);
      ++repairs.missing;
    } else if (!(cell >= rules.lower && cell <= rules.upper)) {
      require(rules.implausible != Implausible::kError, where(r),
              "a value from " + exactText(rules.lower) + " to " + exactText(rules.upper) + " " +
                  (rules.unit.empty() ? "" : rules.unit + " ") + "(another unit? " +
                  rules.implausible_key + " says what to do), got " + exactText(cell));
      ++repairs.implausible;
      const bool clip = rules.implausible == Implausible::kClip;
      if (!clip) fill = fillOf(rules.implausible);
      cell = clip ? std::clamp(cell, rules.lower, rules.upper)
                  : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return fills;
}

/// Index of the first measured cell after each cell; the size if there is none.
std::vector<Index> nextMeasured(const Eigen::Ref<const Vector>& cells) {
  std::vector<Index> next(static_cast<std::size_t>(cells.size()));
  Index following = cells.size();
  for (Index r = cells.size() - 1; r >= 0; --r) {
    next[static_cast<std::size_t>(r)] = following;
    if (!std::isnan(cells[r])) following = r;
  }
  return next;
}

}  // namespace

ColumnRepairs repairColumn(Eigen::Ref<Vector> cells, const std::vector<double>& times,
                           const ColumnRules& rules,
                           const std::function<std::string(Index)>& where) {
  ColumnRepairs repairs;
  const auto fills = judge(cells, rules, where, repairs);
  const auto next = nextMeasured(cells);
  const auto t = [&](Index r) { return times[static_cast<std::size_t>(r)]; };
  require(cells.size() > 0 && !cells.array().isNaN().all(), where(0),
          "at least one number in the column");
  Index before = -1;
  for (Index r = 0; r < cells.size(); ++r) {
    const Fill fill = fills[static_cast<std::size_t>(r)];
    const Index after = next[static_cast<std::size_t>(r)];
    if (fill == Fill::kNone) before = r;
    if (fill == Fill::kNone || fill == Fill::kDrop) continue;
    if (before < 0)
      cells[r] = cells[after];
    else if (fill == Fill::kHold || after == cells.size())
      cells[r] = cells[before];
    else
      cells[r] = cells[before] +
                 (t(r) - t(before)) / (t(after) - t(before)) * (cells[after] - cells[before]);
  }
  return repairs;
}

}  // namespace fpc
