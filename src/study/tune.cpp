#include "study/tune.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "study/run_journal.hpp"
#include "study/tune_state.hpp"

namespace fpc {
namespace {

/// Judges generations: points that the state file knows are looked up, the others are run. The
/// search itself is replayed from its seed, so no method needs a state of its own on disk.
class TuneSession {
 public:
  TuneSession(const TuningObjective& objective, const SearchParams& search,
              const TuneOptions& options)
      : objective_(objective),
        options_(options),
        identity_(identityOf(objective, search)),
        keeps_(objective.pool().leads() && !options.state.empty()),
        journal_(options.state, identity_),
        began_(std::chrono::steady_clock::now()) {
    result_.search = search;
    if (options.resume) readKnown();
    if (!keeps_) return;
    if (!options.resume) std::filesystem::remove(options.state);  // of an older tuning
    journal_.begin();
    for (const auto& [run, text] : runs_) journal_.add(run, text);
  }

  bool judge(const Matrix& points, Vector& costs) {
    const std::size_t first = result_.history.size();
    const auto n = static_cast<std::size_t>(points.cols());
    const std::size_t known = std::min(n, known_.size() - std::min(first, known_.size()));
    std::vector<TuningStep> steps;
    for (std::size_t i = 0; i < known; ++i) {
      steps.push_back(known_[first + i]);
      const auto column = static_cast<Eigen::Index>(i);
      require(steps.back().shares == points.col(column), options_.state,
              "the points that this search asks");
      steps.back().values = objective_.values(points.col(column));
    }
    result_.resumed += static_cast<int>(known);
    if (known < n && !run(points.rightCols(static_cast<Eigen::Index>(n - known)), steps))
      return false;
    for (std::size_t i = 0; i < n; ++i) {
      costs[static_cast<Eigen::Index>(i)] = steps[i].cost;
      keep(std::move(steps[i]));
    }
    if (known < n) save();
    return true;
  }

  TuneResult finish(const SearchResult& found) {
    result_.generations = found.generations;
    result_.stopped = found.stopped;
    if (keeps_ && !found.stopped) journal_.remove();
    return std::move(result_);
  }

 private:
  /// The state file, read by the process that leads and told to those that share its pool, and the
  /// runs that ended after it was written. A tuning that was killed early has only the latter.
  void readKnown() {
    RunPool::Texts state(1);
    if (objective_.pool().leads()) {
      runs_ = journal_.read();
      state[0] = stateText();
    }
    objective_.pool().fill(state, {}, {}, {});
    if (state[0]->empty()) return;
    TuneState known = parseState(*state[0], options_.state, identity_);
    known_ = std::move(known.steps);
    before_ = result_.seconds = known.seconds;
  }

  /// Empty: only the journal is there.
  std::string stateText() const {
    std::ifstream stream(options_.state);
    if (!stream.good() && !runs_.empty()) return {};
    require(stream.good(), options_.state,
            "a readable file, as a stopped `fmbpc tune --out` leaves it");
    std::string text((std::istreambuf_iterator<char>(stream)), {});
    return text.empty() ? "{" : text;  // an empty file is no state
  }

  /// What the journal knows of `count` runs from run `first` on.
  RunPool::Texts knownRuns(std::size_t first, std::size_t count) const {
    RunPool::Texts texts(count);
    for (auto at = runs_.lower_bound(first); at != runs_.end() && at->first < first + count; ++at)
      texts[at->first - first] = at->second;
    return texts;
  }

  bool run(const Matrix& points, std::vector<TuningStep>& steps) {
    const std::size_t scenarios = objective_.tuning().scenarios.size();
    const std::size_t first = (result_.history.size() + steps.size()) * scenarios;
    const auto count = static_cast<std::size_t>(points.cols()) * scenarios;
    const auto scores = objective_.judge(points, options_.stop, knownRuns(first, count),
                                         [&](std::size_t i, const std::string& text) {
                                           if (keeps_) journal_.add(first + i, text);
                                         });
    if (!scores) return false;
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      const TuningScore& score = (*scores)[static_cast<std::size_t>(p)];
      steps.push_back({points.col(p), objective_.values(points.col(p)), score.cost, score.scenarios,
                       score.failures});
      if (result_.trouble.empty()) result_.trouble = score.trouble;
    }
    return true;
  }

  void keep(TuningStep step) {
    const int now = static_cast<int>(result_.history.size());
    if (step.cost < best_) {
      best_ = step.cost;
      result_.best = now;
    }
    result_.failures += step.failures;
    result_.history.push_back(std::move(step));
    if (options_.progress) options_.progress(now + 1, best_);
  }

  void save() {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began_;
    result_.seconds = before_ + wall.count();
    if (!keeps_) return;
    writeState(options_.state, identity_, {result_.history, result_.seconds});
    journal_.begin();
  }

  const TuningObjective& objective_;
  const TuneOptions& options_;
  std::string identity_;
  bool keeps_;  // the state file
  RunJournal journal_;
  std::map<std::size_t, std::string> runs_;  // of the journal
  std::chrono::steady_clock::time_point began_;
  std::vector<TuningStep> known_;
  TuneResult result_;
  double best_{kInfinity};
  double before_{};  // seconds of earlier sessions
};

}  // namespace

TuneResult tune(const TuningObjective& objective, const SearchParams& search,
                const TuneOptions& options) {
  search.validate();
  require(!options.resume || !options.state.empty(), "resume", "a state file to resume from");
  TuneSession session(objective, search, options);
  const auto judge = [&](const Matrix& points, Vector& costs) {
    return session.judge(points, costs);
  };
  const Eigen::Index n = objective.size();
  return session.finish(
      runSearch(search, Vector::Zero(n), Vector::Ones(n), judge, objective.start()));
}

void writeHistory(const TuningFile& tuning, const TuneResult& result, const std::string& file) {
  std::ofstream stream(file);
  stream << "evaluation,cost,best";
  for (const auto& parameter : tuning.parameters) stream << "," << parameter.key;
  for (const auto& scenario : tuning.scenarios) stream << ",cost of " << scenario.name;
  stream << "\n";
  double best = kInfinity;
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    const TuningStep& step = result.history[i];
    best = std::min(best, step.cost);
    stream << i + 1 << "," << exactText(step.cost) << "," << exactText(best);
    for (const double value : step.values) stream << "," << exactText(value);
    for (const double cost : step.scenarios) stream << "," << exactText(cost);
    stream << "\n";
  }
  stream.close();
  require(!stream.fail(), file, "a writable file");
}

}  // namespace fpc
