#include "identification/contradiction.hpp"

#include <algorithm>
#include <cstdio>

#include "fmbpc/base/text.hpp"
#include "identification/auto_choice.hpp"
#include "identification/auto_structures.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kMuchWorse = 1.1;     // errors of models that agree, over those of free ones
constexpr double kContradicts = 10.0;  // [%] of fit: a model that says less speaks against nothing
constexpr double kSoftest = 1e-3;      // ridge of the linear models looked at
constexpr Index kFewestContradicting = 60;

/// One statement, and how to take it back.
struct Statement {
  std::string words;
  std::function<void(PriorKnowledge&)> drop;
};

std::vector<Statement> statementsOf(const PriorKnowledge& known, const DataSet& data) {
  std::vector<Statement> all;
  const auto of = [&](const std::vector<int>& signs, std::size_t j) {
    return j < signs.size() ? signs[j] : 0;
  };
  for (std::size_t j = 0; j < data.inputs.size() + data.disturbances.size(); ++j) {
    const auto& signal =
        j < data.inputs.size() ? data.inputs[j] : data.disturbances[j - data.inputs.size()];
    const int gain = of(known.gain, j), monotone = of(known.monotone, j);
    if (gain == 0 && monotone == 0) continue;
    const std::string key = monotone == 0 ? "known.gain"
                            : gain == 0   ? "known.monotone"
                                          : "known.gain and known.monotone";
    all.push_back({key + " of " + signal.name +
                       ((monotone != 0 ? monotone : gain) > 0 ? " (positive)" : " (negative)"),
                   [j](PriorKnowledge& k) {
                     if (j < k.gain.size()) k.gain[j] = 0;
                     if (j < k.monotone.size()) k.monotone[j] = 0;
                   }});
  }
  if (known.max_pole > 0.0)
    all.push_back({"known.max_pole (" + shortText(known.max_pole) + ")",
                   [](PriorKnowledge& k) { k.max_pole = 0.0; }});
  for (std::size_t i = 0; i < known.steady.size(); ++i)  // taken back in place: the others stay
    all.push_back({"known.steady (number " + std::to_string(i + 1) + ")",
                   [i](PriorKnowledge& k) { k.steady[i].within = kInfinity; }});
  return all;
}

PriorKnowledge without(PriorKnowledge known, const std::vector<Statement>& statements,
                       const std::vector<char>& dropped) {
  for (std::size_t i = 0; i < statements.size(); ++i)
    if (dropped[i] != 0) statements[i].drop(known);
  auto& rests = known.steady;
  rests.erase(std::remove_if(rests.begin(), rests.end(),
                             [](const KnownRest& r) { return !std::isfinite(r.within); }),
              rests.end());
  return known;
}

class Doubt {
 public:
  Doubt(const AutoData& data, const std::vector<std::vector<int>>& delays,
        const SearchLimits& limits)
      : data_(data), limits_(limits), statements_(statementsOf(data.known, *data.data)) {
    limits_.progress = {};
    for (std::size_t i = 0; i < delays.size(); ++i)
      if (i == 0 || delays[i] != delays[0]) addCandidates(delays[i]);
  }

  std::string words() {
    std::vector<char> dropped(statements_.size(), 0);
    const AutoFigures bound = bestWithout(dropped);
    free_ = bestWithout(std::vector<char>(statements_.size(), 1));
    if (!(free_.fit > kContradicts) || !isWorse(bound, free_)) return "";
    if (onlySigns(data_.known) && std::isfinite(bound.mean) &&
        !isWorse(bestWithout(dropped, true),
                 bestWithout(std::vector<char>(dropped.size(), 1), true)))
      return "";  // rules may bend against a sign that the process as a whole has
    AutoFigures now = bound;
    std::vector<std::string> blamed;
    while (isWorse(now, free_) && blamed.size() < statements_.size()) {
      const std::size_t next = dropNext(dropped, now);
      if (next == statements_.size()) return "";  // stopped
      blamed.push_back(statements_[next].words);
    }
    return "the record contradicts " + join(blamed, " and ") + ": free run over held-out blocks " +
           (std::isfinite(bound.mean) ? shortText(bound.mean) + " with it"
                                      : "of no model that agrees") +
           ", " + shortText(now.mean) + " without";
  }

 private:
  void addCandidates(const std::vector<int>& delay) {
    Candidate base;
    base.delay = delay;
    for (const auto& c : linearCandidates(base, false))
      if (!(c.linear_ridge > kSoftest)) candidates_.push_back(c);
    Candidate rules = candidates_.front();
    rules.order = rules.input_terms = rules.rules = 2;
    rules.free_run = true;
    for (const auto on : {AntecedentChoice::kOutput, AntecedentChoice::kInputs,
                          AntecedentChoice::kOutputAndInputs}) {
      rules.antecedents = on;
      candidates_.push_back(rules);
    }
  }

  /// Figures of the best of all candidates; an infinite mean: none ran.
  AutoFigures bestWithout(const std::vector<char>& dropped, bool lines = false) {
    AutoData data = data_;
    data.known = without(data_.known, statements_, dropped);
    AutoFigures best;
    best.mean = kInfinity;
    for (const auto& j : judgeCandidates(data, candidates_, limits_)) {
      if (lines && j.candidate.rules > 1) continue;
      if (!std::isfinite(j.score) || !(meanBlockError(data, j.free_run) < best.mean)) continue;
      best = figuresOf(data, j.free_run, j.one_step);
    }
    return best;
  }

  static bool isWorse(const AutoFigures& bound, const AutoFigures& free) {
    if (!std::isfinite(bound.mean)) return true;
    return bound.mean > kMuchWorse * free.mean && beyondSpread(free, bound);
  }
  static bool onlySigns(const PriorKnowledge& known) {
    return !(known.max_pole > 0.0) && known.steady.empty();
  }

  /// Drops the statement without which models run best; `now` becomes what they reach.
  std::size_t dropNext(std::vector<char>& dropped, AutoFigures& now) {
    std::size_t next = statements_.size();
    AutoFigures best;
    best.mean = kInfinity;
    for (std::size_t i = 0; i < statements_.size(); ++i) {
      if (dropped[i] != 0) continue;
      std::vector<char> trial = dropped;
      trial[i] = 1;
      const AutoFigures f = bestWithout(trial);
      if (next < statements_.size() && !(f.mean < best.mean)) continue;
      next = i;
      best = f;
    }
    if (next == statements_.size() || limits_.isOver()) return statements_.size();
    dropped[next] = 1;
    now = best;
    return next;
  }

  const AutoData& data_;
  SearchLimits limits_;
  std::vector<Statement> statements_;
  std::vector<Candidate> candidates_;
  AutoFigures free_;
};

}  // namespace

std::string contradiction(const AutoData& data, const std::vector<std::vector<int>>& delays,
                          const SearchLimits& limits) {
  return Doubt(data, delays, limits).words();
}

std::string contradiction(const DataSet& given, int output,
                          const std::vector<Regressor>& regressors, const PriorKnowledge& known) {
  constexpr int kBlocks = 4;
  constexpr Index kMostRows = 2000;
  DataSet data = given;
  const std::size_t n_y = data.outputs.size(), n_u = data.inputs.size();
  std::vector<int> delay(n_u + data.disturbances.size(), -1);
  for (const auto& r : regressors) {
    if (r.kind == SignalKind::kOutput) continue;
    const auto at =
        static_cast<std::size_t>(r.index) + (r.kind == SignalKind::kDisturbance ? n_u : 0);
    delay[at] = delay[at] < 0 ? r.lag : std::min(delay[at], r.lag);
  }
  data.constant.assign(static_cast<std::size_t>(data.values.cols()), false);
  bool any = false;
  for (std::size_t j = 0; j < delay.size(); ++j) {
    data.constant[n_y + j] = delay[j] < 0;
    any = any || delay[j] >= 0;
    delay[j] = std::max(delay[j], 0);
  }
  if (!any || data.rows() < kFewestContradicting) return "";
  AutoData prepared = prepareAuto(data, output, kBlocks, kMostRows, kMostRows);
  prepared.known = known;
  SearchLimits limits;
  return contradiction(prepared, {delay}, limits);
}

}  // namespace fpc
