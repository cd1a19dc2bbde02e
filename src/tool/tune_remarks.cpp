// What a tuning does not say by its numbers alone: ranges that held it back, runs it made worse,
// costs that told it nothing.
#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "tool/tune_report.hpp"

namespace fpc::tool {
namespace {

constexpr double kAtBound = 1e-3;  // of the range, in its scale
constexpr double kSame = 1e-12;    // relative: costs that differ by less are the same

const TuningStep& bestOf(const TunedLoop& tuned) {
  return tuned.result.history[static_cast<std::size_t>(tuned.result.best)];
}

void addIf(const std::string& words, std::vector<std::string>& remarks) {
  if (!words.empty()) remarks.push_back(words);
}

}  // namespace

bool isOutside(const TuningParameter& parameter, double own) {
  return own < parameter.lower || own > parameter.upper;
}

std::string boundOf(const TuningParameter& parameter, double value) {
  const double share = parameter.share(value);
  if (share <= kAtBound) return "lower";
  return share >= 1.0 - kAtBound ? "upper" : "";
}

std::string worsening(const TuningObjective& objective, const TunedLoop& tuned) {
  if (tuned.result.best < 0) return "";
  const double untouched = objective.untouched().cost, found = bestOf(tuned).cost;
  if (!tuned.held_out)
    return found > untouched ? "the tuned cost is worse than that of the untouched loop, " +
                                   shortText(untouched) + " -> " + shortText(found)
                             : "";
  const double before = objective.untouchedHeldOut().cost, after = tuned.held_out->cost;
  return after > before ? "the cost on held-out scenarios got worse, " + shortText(before) +
                              " -> " + shortText(after) + ": what was found does not carry over"
                        : "";
}

std::string nothingFound(const TuningObjective& objective, const TuneResult& result) {
  if (result.best < 0 || result.stopped || result.history.size() < 2) return "";
  const double most = objective.tuning().fitness.failure;
  const std::string all =
      "nothing was found: all " + std::to_string(result.history.size()) + " points cost ";
  const auto isMost = [&](const TuningStep& step) { return step.cost >= most; };
  if (std::all_of(result.history.begin(), result.history.end(), isMost))
    return all + shortText(most) + ", fitness.failure, the most that a run can cost";
  const double first = result.history.front().cost;
  const auto isSame = [&](const TuningStep& step) {
    return std::abs(step.cost - first) <= kSame * std::abs(first);
  };
  if (std::all_of(result.history.begin(), result.history.end(), isSame))
    return all + "the same, " + shortText(first) + ": no parameter acts on this cost in its range";
  return "";
}

std::string verdictOf(const TuningObjective& objective, const TunedLoop& tuned) {
  const std::string nothing = nothingFound(objective, tuned.result);
  return nothing.empty() ? worsening(objective, tuned) : nothing;
}

std::vector<std::string> remarksOf(const TuningObjective& objective, const TunedLoop& tuned) {
  std::vector<std::string> remarks;
  if (tuned.result.best < 0) return remarks;
  const std::string nothing = nothingFound(objective, tuned.result);
  addIf(nothing, remarks);
  const auto& parameters = objective.tuning().parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = bestOf(tuned).values[i];
    const std::string bound = boundOf(parameters[i], value);
    if (!bound.empty() && nothing.empty())
      remarks.push_back(parameters[i].key + " ends at the " + bound + " bound of its range, " +
                        shortText(value) + ": the best may lie beyond");
    const double own = objective.own()[i];
    if (isOutside(parameters[i], own))
      remarks.push_back(parameters[i].key + " of the untouched loop, " + shortText(own) +
                        ", lies outside its range " + shortText(parameters[i].lower) + ".." +
                        shortText(parameters[i].upper));
  }
  if (tuned.held_out) addIf(worsening(objective, {tuned.loop, tuned.result, {}}), remarks);
  addIf(worsening(objective, tuned), remarks);
  return remarks;
}

}  // namespace fpc::tool
