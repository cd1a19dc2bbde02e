#include "identification/auto_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "identification/auto_choice.hpp"

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kTells = 10.0;  // [%] of fit: less is hardly more than the mean
constexpr double kBetterThanHold = 0.97;
constexpr double kWorseAhead = 1.05;  // of the linear model's error one sample ahead

/// "free run", or what stands for it.
std::string runWords(const AutoOutput& found) {
  return found.reach > 0 ? "runs of " + std::to_string(found.reach) + " samples" : "free run";
}

std::string lowestFuzzyText(const AutoOutput& found) {
  double lowest = kInfinity;
  for (const auto* f : {&found.regressors, &found.state, &found.blend})
    if (!f->blocks.empty()) lowest = std::min(lowest, f->confirmed);
  return std::isfinite(lowest) ? runWords(found) + " " + shortText(lowest) : "none ran to the end";
}

/// A model that is chosen by its free runs may be the worse one for who predicts a sample.
std::string oneStepWords(const AutoFigures& best, const AutoFigures& line) {
  if (!(best.one_step > kWorseAhead * line.one_step)) return "";
  return "; one sample ahead it is worse than linear: " + shortText(best.one_step) + " beside " +
         shortText(line.one_step);
}

std::string verdictOf(const AutoOutput& found, const AutoFigures& best) {
  const AutoFigures& line = found.linear;
  if (!found.beats_linear)
    return "no fuzzy model beats the best linear one beyond the spread over held-out blocks (" +
           lowestFuzzyText(found) + ", beside " + shortText(line.confirmed) +
           "): the linear model is written";
  std::string words =
      "the fuzzy model beats linear beyond the spread over held-out blocks: " + runWords(found) +
      " " + shortText(best.confirmed) + " beside " + shortText(line.confirmed) +
      " of the best linear one, each block by a choice that did not look at it";
  if (found.best == ModelKind::kState)
    words += "; it has a state of its own, for simulation; what control laws take reaches " +
             shortText(found.fuzzy_model ? found.regressors.confirmed : line.confirmed) +
             (found.fuzzy_model ? "" : " (linear)");
  if (found.best == ModelKind::kBlend)
    words +=
        "; it is the mean of the models of the measured past and with a state of its own, for "
        "simulation; the former, which control laws take, reaches " +
        shortText(found.regressors.confirmed);
  return words + oneStepWords(best, line);
}

}  // namespace

void decide(AutoOutput& found) {
  const AutoFigures* best = &found.linear;
  found.best = ModelKind::kLinear;
  if (found.fuzzy_model && !isWorthIt(found.regressors, found.linear)) {
    found.fuzzy_model = false;
    found.blend = {};
  }
  if (found.fuzzy_model) {
    best = &found.regressors;
    found.best = ModelKind::kRegressors;
  }
  for (const auto& [kind, own] :
       {std::pair{ModelKind::kState, &found.state}, std::pair{ModelKind::kBlend, &found.blend}}) {
    if (own->blocks.empty() || !(own->fit > 0.0) || !isLower(*own, *best) ||
        !beyondSpread(*own, found.linear))
      continue;
    best = own;
    found.best = kind;
  }
  found.beats_linear = found.best != ModelKind::kLinear;
  found.verdict = verdictOf(found, *best);
  const AutoFigures& laws = found.fuzzy_model ? found.regressors : found.linear;
  if (best->fit > kTells && !(laws.fit > 0.0))
    found.verdict += "; what control laws take is worse than the mean of the record in " +
                     runWords(found) + " (fit " + shortText(laws.fit) + " %)";
  if (found.hold > 0.0 && !(best->free_run < kBetterThanHold * found.hold))
    found.verdict = "no model predicts " + std::to_string(found.reach) +
                    " samples better than the last measured value does (" +
                    shortText(best->free_run) + " beside " + shortText(found.hold) +
                    "): do not trust any of them there (" + found.verdict + ")";
  if (best->fit > kTells || found.hold > 0.0) return;
  found.verdict = (best->fit > 0.0 ? "no model says much more than the mean of the record in " +
                                         runWords(found) + " over held-out blocks (fit " +
                                         shortText(best->fit) + " %): "
                                   : "no model says more than the mean of the record in " +
                                         runWords(found) + " over held-out blocks: ") +
                  "do not trust any of them there (" + found.verdict + ")";
}

}  // namespace fpc
