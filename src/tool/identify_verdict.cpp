#include "tool/identify_verdict.hpp"

#include <algorithm>
#include <cstdio>

#include "fmbpc/base/text.hpp"

namespace fpc::tool {
namespace {

const FitFigures* freeRunOf(const OutputJudgement& o, ModelKind kind) {
  const KindFigures* f = figuresOf(o, kind);
  return f != nullptr && f->free_run.samples > 0 ? &f->free_run : nullptr;
}

/// Free runs of a kind, over those of the linear model; 0: one of the two is not there.
double ratioToLinear(const OutputJudgement& o, ModelKind kind) {
  const FitFigures *own = freeRunOf(o, kind), *line = freeRunOf(o, ModelKind::kLinear);
  return own != nullptr && line != nullptr ? own->rmse / std::max(line->rmse, 1e-300) : 0.0;
}

std::string besideText(const OutputJudgement& o, ModelKind kind) {
  return "free run " + shortText(freeRunOf(o, kind)->rmse) + " beside " +
         shortText(freeRunOf(o, ModelKind::kLinear)->rmse);
}

void makeLinear(std::size_t output, AutoIdentification& found) {
  found.model.submodels[output] = found.linear.submodels[output];
  found.outputs[output].fuzzy_model = false;
  found.outputs[output].blend = {};
}

}  // namespace

bool chooseByValidation(const RecordJudgement& validation, AutoIdentification& found) {
  bool changed = false;
  for (std::size_t i = 0; i < found.outputs.size(); ++i) {
    AutoOutput& o = found.outputs[i];
    const OutputJudgement& judged = validation.outputs[i];
    const auto isWorse = [&](ModelKind kind) { return ratioToLinear(judged, kind) > kWorse; };
    const ModelKind before = o.best;
    const bool was_fuzzy = o.fuzzy_model;
    std::string words;
    if (before != ModelKind::kLinear && isWorse(before)) words = besideText(judged, before);
    if (was_fuzzy && isWorse(ModelKind::kRegressors)) makeLinear(i, found);
    if (!words.empty()) {
      o.best = o.fuzzy_model ? ModelKind::kRegressors : ModelKind::kLinear;
      o.beats_linear = o.fuzzy_model;
      o.verdict = "the fuzzy model is worse than the best linear one on the validation rows (" +
                  words + "): the " +
                  (o.fuzzy_model ? "model of the measured past" : "linear model") +
                  " is written (these rows have helped to choose; a call without them keeps the "
                  "other; over held-out blocks: " +
                  o.verdict + ")";
    } else if (was_fuzzy && !o.fuzzy_model) {
      o.verdict += "; on the validation rows what control laws take is worse than linear (" +
                   besideText(judged, ModelKind::kRegressors) + "): they get the linear model";
      if (before == ModelKind::kBlend) {
        o.beats_linear = !isWorse(ModelKind::kState);
        o.best = o.beats_linear ? ModelKind::kState : ModelKind::kLinear;
        o.verdict += ", and of the mean of both only '" + name(o.best) + "' is left";
      }
    }
    changed = changed || o.best != before || o.fuzzy_model != was_fuzzy;
  }
  return changed;
}

std::vector<std::string> warnings(const RecordJudgement& part) {
  std::vector<std::string> words;
  for (const auto& o : part.outputs) {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
    for (const auto kind : {ModelKind::kBlend, ModelKind::kState, ModelKind::kRegressors})
      if ((kind == o.best || kind == ModelKind::kRegressors) && ratioToLinear(o, kind) > kWorse)
        add("the fuzzy model '" + name(kind) + "' is worse than the linear one (" +
            besideText(o, kind) + "): take the linear model of the file");
    const auto addPoor = [&](ModelKind kind, const FitFigures& ahead, const std::string& who) {
      const FitFigures* free = freeRunOf(o, kind);
      if (free != nullptr && free->fit < 0.0)
        add("the free run of " + who + " is worse than the mean of these rows (fit " +
            shortText(free->fit) + " %)");
      if (free != nullptr && ahead.samples > 0 && ahead.fit < 0.0)
        add(std::to_string(part.steps) + " steps ahead " + who +
            " is worse than the mean of these rows (RMSE " + shortText(ahead.rmse) +
            "): not for control");
    };
    addPoor(o.best, o.ahead, "the model");
    if (o.laws != o.best) addPoor(o.laws, o.laws_ahead, "what control laws take");
    if (!text.empty()) words.push_back(o.output + ": " + text);
  }
  return words;
}

std::string coverageWords(const OutputJudgement& o) {
  const KindFigures& f = bestFigures(o);
  std::string words;
  const auto add = [&words](const char* ahead, double covered, double least) {
    if (!(covered < least)) return;
    char text[96];
    std::snprintf(text, sizeof text, "%.3g %% %s (chance leaves %.3g %% or more)", covered, ahead,
                  least);
    words += (words.empty() ? "its 95 % intervals hold only " : " and ") + std::string(text);
  };
  add("one step ahead", f.one_step_coverage, f.one_step_least);
  add("in free run", f.free_run_coverage, f.free_run_least);
  return words;
}

void tellCoverage(const RecordJudgement& validation, AutoIdentification& found) {
  for (std::size_t i = 0; i < found.outputs.size(); ++i) {
    const std::string words = coverageWords(validation.outputs[i]);
    if (!words.empty()) found.outputs[i].verdict += "; on the validation rows " + words;
  }
}

void chooseByKind(ModelKind kind, AutoIdentification& found) {
  for (std::size_t i = 0; i < found.outputs.size(); ++i) {
    AutoOutput& o = found.outputs[i];
    const ModelKind before = o.best;
    if (kind == ModelKind::kLinear) makeLinear(i, found);
    if (kind == ModelKind::kState && !found.state.outputs.empty()) o.best = kind;
    if (kind != ModelKind::kState)
      o.best = o.fuzzy_model ? ModelKind::kRegressors : ModelKind::kLinear;
    if (o.best == before) continue;
    o.beats_linear = false;
    const AutoFigures& f = o.best == ModelKind::kState        ? o.state
                           : o.best == ModelKind::kRegressors ? o.regressors
                                                              : o.linear;
    o.verdict = name(o.best) + ", as --kind asks: free run " + shortText(f.mean) +
                " over held-out blocks (" + o.verdict + ")";
  }
  if (kind != ModelKind::kState) found.state.outputs.clear();
}

}  // namespace fpc::tool
