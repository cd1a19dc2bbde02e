#include "identification/auto_output.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/auto_choice.hpp"
#include "identification/auto_confirm.hpp"
#include "identification/auto_delay.hpp"
#include "identification/auto_structures.hpp"
#include "identification/contradiction.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::size_t kShown = 5;  // trials of each kind in the report
constexpr double kUseless = 0.98;  // of the score with an input: what models without it must reach
constexpr int kLongestDelay = 100;
constexpr Index kRowsPerDelay = 10;

/// Everything of one output.
class OutputSearch {
 public:
  OutputSearch(const DataSet& data, int output, const AutoParams& params,
               const SearchLimits& limits, AutoIdentification& result)
      : data_(prepareAuto(data, output, params.blocks, params.most_rows, params.most_last)),
        params_(params),
        limits_(limits),
        result_(result) {
    data_.reach = params.reach;
    found_.reach = params.reach;
    if (!params.known.empty()) data_.known = params.known[static_cast<std::size_t>(output)];
  }

  SearchedOutput run() {
    found_.output = name();
    findDelays();
    leaveOutCauses();
    searched_ =
        searchStructures(data_, found_.delay, params_.states, params_.seed, limits_, second_);
    if (searched_.skipped > 0)
      remark(leftOutWords(limits_, std::to_string(searched_.skipped) + " of the fits"));
    require(!searched_.linear.empty(), data_.data->source + ": output '" + name() + "'",
            "a linear model that runs freely without leaving the data; none did in all of " +
                std::to_string(data_.windows.size()) +
                " blocks (fewer --blocks or a smaller --window, if a block has only few rows)" +
                (contradiction_.empty() ? "" : "; " + contradiction_));
    confirmed_ = confirmChoices(data_, searched_);
    chooseModels();
    chooseState();
    chooseBlend();
    found_.hold = holdError();
    keepTrials();
    for (const auto* model : {&result_.linear, &result_.model})
      for (const auto& key :
           brokenKnowledge(model->submodels.back(), data_.output, *data_.data, data_.known))
        remark("the model breaks what is known of it: " + key);
    if (data_.lower < data_.upper) {
      found_.sensor_lower = inUnit(data_.lower);
      found_.sensor_upper = inUnit(data_.upper);
    }
    result_.outputs.push_back(found_);
    alone_.data = std::move(data_);
    return std::move(alone_);
  }

 private:
  const std::string& name() const {
    return data_.data->outputs[static_cast<std::size_t>(data_.output)].name;
  }
  void remark(const std::string& text) { result_.remarks.push_back(name() + ": " + text); }
  double inUnit(double scaled) const {
    return data_.shift[data_.output] + data_.scale[data_.output] * scaled;
  }

  void findDelays() {
    const auto usual =
        static_cast<int>(std::min<Index>(kLongestDelay, data_.data->rows() / kRowsPerDelay));
    const int longest =
        params_.longest_delay > 0
            ? std::min<int>(params_.longest_delay, static_cast<int>(data_.data->rows() / 2))
            : usual;
    const DelayGuess guess = guessDelays(data_, longest);
    found_.delay = guess.delay;
    if (guess.isOpen())
      found_.delay = bestDelays(data_, guess, guessDelaysByBlock(data_, longest, limits_.threads),
                                params_.seed, limits_);
    takeEarlier();
    remarkDelays(guess, longest);
    if (!data_.known.empty()) contradict({guess.delay, found_.delay});
  }

  /// Lowest score of linear models, those with later values of the inputs among them.
  double lowestScore(const AutoData& data, const std::vector<int>& delay,
                     const std::vector<int>& second) const {
    Candidate base;
    base.delay = delay;
    base.seed = params_.seed;
    Candidates list = delayCandidates(base);
    if (!second.empty())
      for (const auto& c : laterLines(base, second)) list.push_back(c);
    base.order = base.input_terms = 4;
    for (const bool free : {false, true}) {
      base.free_run = free;
      list.push_back(base);
    }
    SearchLimits limits = limits_;
    limits.progress = {};
    double lowest = kInfinity;
    for (const auto& j : judgeCandidates(data, list, limits)) lowest = std::min(lowest, j.score);
    return lowest;
  }

  /// An inverse response acts before most of its effect comes.
  void takeEarlier() {
    const std::vector<int> earlier = earliestDelays(data_, found_.delay);
    if (earlier == found_.delay ||
        !(lowestScore(data_, earlier, found_.delay) < lowestScore(data_, found_.delay, {})))
      return;
    second_ = found_.delay;
    found_.delay = earlier;
  }

  bool isKnown(std::size_t cause) const {
    const auto says = [cause](const std::vector<int>& signs) {
      return cause < signs.size() && signs[cause] != 0;
    };
    return says(data_.known.gain) || says(data_.known.monotone) || !data_.known.steady.empty();
  }

  /// Lowest score of two rules on the inputs: they see what bends.
  double lowestOfRules(const AutoData& data) const {
    Candidate c;
    c.delay = found_.delay;
    c.seed = params_.seed;
    c.rules = 2;
    c.iterations = 60;
    c.antecedents = AntecedentChoice::kInputs;
    Candidates list;
    for (const int n : {1, 2}) {
      c.order = c.input_terms = n;
      list.push_back(c);
    }
    SearchLimits limits = limits_;
    limits.progress = {};
    double lowest = kInfinity;
    for (const auto& j : judgeCandidates(data, list, limits)) lowest = std::min(lowest, j.score);
    return lowest;
  }

  /// Inputs without which models run better over the held-out blocks, one after the other.
  void leaveOutCauses() {
    const std::size_t m = found_.delay.size();
    std::vector<std::size_t> left;
    for (std::size_t j = 0; j < m; ++j)
      if (!data_.isLeftOut(j)) left.push_back(j);
    if (left.size() < 2 || params_.keep_still) return;
    data_.unused.assign(m, false);
    double now = lowestScore(data_, found_.delay, second_), bent = -1.0;
    while (left.size() > 1) {
      std::size_t worst = m;
      double lowest = kUseless * now;
      for (const std::size_t j : left) {
        if (isKnown(j)) continue;
        AutoData without = data_;
        without.unused[j] = true;
        const double score = lowestScore(without, found_.delay, second_);
        if (score < lowest) lowest = score, worst = j;
      }
      if (worst == m || limits_.isOver()) return;
      if (bent < 0.0) bent = lowestOfRules(data_);
      AutoData without = data_;
      without.unused[worst] = true;
      const double other = lowestOfRules(without);
      if (!(other < bent)) return;  // what it does may bend
      const std::size_t n_u = data_.data->inputs.size();
      remark(
          (worst < n_u ? data_.data->inputs[worst] : data_.data->disturbances[worst - n_u]).name +
          " is left out: models without it run closer over held-out blocks (score " +
          shortText(lowest) + " beside " + shortText(now) + "; --keep-inputs keeps it)");
      data_.unused[worst] = true;
      left.erase(std::find(left.begin(), left.end(), worst));
      now = lowest;
      bent = other;
    }
  }

  void contradict(const std::vector<std::vector<int>>& delays) {
    contradiction_ = contradiction(data_, delays, limits_);
    if (!contradiction_.empty()) result_.contradictions.push_back(name() + ": " + contradiction_);
  }

  void remarkDelays(const DelayGuess& guess, int longest) {
    for (std::size_t j = 0; j < guess.delay.size(); ++j) {
      const std::size_t n_u = data_.data->inputs.size();
      const auto& signal = j < n_u ? data_.data->inputs[j] : data_.data->disturbances[j - n_u];
      const std::string words = std::to_string(found_.delay[j]) + " samples fit best, ";
      if (found_.delay[j] >= longest)
        remark("delay of " + signal.name + ": " + words +
               "the longest that was tried (--longest-delay)");
      else if (guess.doubt[j] && found_.delay[j] == guess.delay[j])
        remark("delay of " + signal.name + " doubtful: " + words + "others as well");
    }
  }

  /// The best of a kind whose fit to all rows comes within `most` times its held-out error; -1:
  /// none.
  int settle(const std::vector<Judgement>& judged, OutputModel& model, double most) {
    for (std::size_t i = 0; i < std::min<std::size_t>(judged.size(), 4); ++i) {
      if (judged[i].candidate.hidden) continue;
      const Fitted whole = fitWhole(data_, judged[i], params_.window, most);
      if (!whole.finite) {
        remark("'" + judged[i].candidate.text() + "' is passed over: fitted to all rows, it runs " +
               (std::isfinite(whole.error) ? "more than twice as far off as held out"
                : whole.wild               ? "away under larger inputs"
                                           : "away"));
        continue;
      }
      if (whole.rows < rowsOf(data_.all))
        remark("'" + judged[i].candidate.text() + "' is fitted to " + std::to_string(whole.rows) +
               " rows only: fitted to all, it runs away under larger inputs");
      model = toSubmodel(data_, whole);
      return static_cast<int>(i);
    }
    return -1;
  }

  void chooseModels() {
    std::vector<Judgement> lines;
    for (const auto& j : searched_.linear)
      if (!j.candidate.hidden) lines.push_back(j);
    OutputModel linear, fuzzy;
    const int line = settle(lines, linear, kInfinity);
    require(line >= 0, data_.data->source + ": output '" + name() + "'",
            "a linear model that can be fitted to all rows");
    const Judgement& l = lines[static_cast<std::size_t>(line)];
    found_.linear = figuresOf(data_, l.free_run, l.one_step, confirmed_.linear);
    linear_text_ = l.candidate.text();
    result_.linear.submodels.push_back(linear);
    const int rules = settle(searched_.regressors, fuzzy, 2.0);
    fuzzy_chosen_ = false;
    if (rules >= 0) {
      const Judgement& r = searched_.regressors[static_cast<std::size_t>(rules)];
      found_.regressors = figuresOf(data_, r.free_run, r.one_step, confirmed_.regressors);
      fuzzy_chosen_ = found_.regressors.fit > 0.0 && isWorthIt(found_.regressors, found_.linear);
      fuzzy_text_ = r.candidate.text();
      fuzzy_ = &r;
      alone_.fuzzy = r.candidate;
    }
    alone_.linear = l.candidate;
    found_.fuzzy_model = fuzzy_chosen_;
    result_.model.submodels.push_back(fuzzy_chosen_ ? fuzzy : linear);
  }

  void chooseState() {
    if (!params_.states) return;
    committee_ = chooseCommittee(data_, searched_);
    const Committee& committee = committee_;
    std::vector<Fitted> fitted(committee.members.size());
    parallelFor(fitted.size(), params_.threads, [&](std::size_t i) {
      fitted[i] = fitWhole(data_, *committee.members[i], params_.window);
    });
    dropStuck(committee, fitted);
    StateOutput state;
    state.shift = data_.shift[data_.output];
    state.scale = data_.scale[data_.output];
    const Index m = data_.shift.size() - static_cast<Index>(data_.data->outputs.size());
    state.exogenous_shift = data_.shift.tail(m);
    state.exogenous_scale = data_.scale.tail(m);
    for (const auto& f : fitted)
      if (f.finite) state.members.push_back({f.shape, f.exogenous, f.parameters, f.prior});
    if (state.members.empty()) {
      states_complete_ = false;
      return;
    }
    state.correction = committee.correction;
    found_.state = figuresOf(data_, committee.free_run, committee.one_step, confirmed_.state);
    state.free_run_width = found_.state.width;
    state.one_step_width = found_.state.one_step_width;
    for (const auto* j : committee.members) members_.push_back(j->candidate.text());
    result_.state.outputs.push_back(std::move(state));
  }

  /// The mean of both fuzzy kinds, if the file will hold them: their errors differ, so that part of
  /// them cancels.
  void chooseBlend() {
    if (!fuzzy_chosen_ || found_.state.blocks.empty()) return;
    found_.blend = figuresOf(data_, meanOf(fuzzy_->free_run, committee_.free_run),
                             meanOf(fuzzy_->one_step, committee_.one_step),
                             meanOf(confirmed_.regressors, confirmed_.state));
  }

  /// rmse of the last measured value over runs of `reach` samples.
  double holdError() const {
    double sum = 0.0, n = 0.0;
    if (data_.reach == 0) return 0.0;
    const auto y = data_.data->values.col(data_.output);
    for (const Stretch& run : runsOf(data_, data_.windows))
      for (Index k = run.first + kRunStart; k < run.last; ++k) {
        const double error = y[k] - y[run.first + kRunStart - 1];
        if (std::isfinite(error)) sum += error * error, n += 1.0;
      }
    return n > 0.0 ? std::sqrt(sum / n) : 0.0;
  }

  void keepTrials() {
    keepKind(searched_.linear, false, ModelKind::kLinear, {linear_text_});
    keepKind(searched_.regressors, false, ModelKind::kRegressors,
             fuzzy_chosen_ ? std::vector<std::string>{fuzzy_text_} : std::vector<std::string>{});
    keepKind(searched_.linear, true, ModelKind::kState, members_);
    for (std::size_t g = 0; g < std::min(kShown, searched_.state.size()); ++g) {
      const Group& group = searched_.state[g];
      const Judgement& first = group.members.front();
      const bool picked =
          std::find(members_.begin(), members_.end(), first.candidate.text()) != members_.end();
      keep(ModelKind::kState,
           first.candidate.text() + ", " + std::to_string(group.members.size()) + " starts",
           first.parameters, blockErrors(data_, group.free_run), picked);
    }
  }

  void keepKind(const std::vector<Judgement>& judged, bool hidden, ModelKind kind,
                const std::vector<std::string>& chosen) {
    std::size_t shown = 0;
    for (const auto& j : judged) {
      if (j.candidate.hidden != hidden || shown++ >= kShown) continue;
      const std::string text = j.candidate.text();
      keep(kind, text, j.parameters, j.blocks,
           std::find(chosen.begin(), chosen.end(), text) != chosen.end());
    }
  }

  void keep(ModelKind kind, const std::string& text, Index parameters,
            const std::vector<double>& blocks, bool picked) {
    double n = 0.0, mean = 0.0, square = 0.0;
    for (const double b : blocks)
      if (std::isfinite(b)) n += 1.0, mean += b;
    mean /= std::max(n, 1.0);
    for (const double b : blocks)
      if (std::isfinite(b)) square += (b - mean) * (b - mean);
    result_.trials.push_back(
        {name(), kind, text, parameters, mean, std::sqrt(square / std::max(n, 1.0)), picked});
  }

  AutoData data_;
  const AutoParams& params_;
  const SearchLimits& limits_;
  AutoIdentification& result_;
  AutoOutput found_;
  SearchedOutput alone_;
  StructureSearch searched_;
  Confirmation confirmed_;
  Committee committee_;
  const Judgement* fuzzy_{nullptr};  ///< of the fuzzy model, in searched_
  bool fuzzy_chosen_{false}, states_complete_{true};
  std::vector<int> second_;  ///< where most of an inverse response comes; empty: none seen
  std::string linear_text_, fuzzy_text_, contradiction_;
  std::vector<std::string> members_;
};

}  // namespace

SearchedOutput searchOutput(const DataSet& data, int output, const AutoParams& params,
                            const SearchLimits& limits, AutoIdentification& result) {
  return OutputSearch(data, output, params, limits, result).run();
}

}  // namespace fpc
