#include "study/study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <tuple>

#include "fmbpc/base/input_error.hpp"
#include "runtime/run.hpp"
#include "study/run_journal.hpp"
#include "study/study_state.hpp"

namespace fpc {
namespace {

// A state file is not written more often; what comes in between stands in its journal.
constexpr std::chrono::seconds kKeepEvery{2};

RunJudgement failed(const std::string& words) {
  RunJudgement run;
  run.cost = run.move = run.least = run.largest_move = std::numeric_limits<double>::infinity();
  run.failures[static_cast<std::size_t>(RunFailure::kDiverged)] = 1;
  run.trouble = words;
  return run;
}

/// A seed that changes nothing makes one case of many: whatever the reason, such a study is none.
void requireDifferentCases(const StudyPlan& plan, const StudyResult& result) {
  std::map<std::tuple<std::size_t, std::string, std::uint64_t>, std::size_t> first;
  for (std::size_t run = 0; run < plan.runs(); ++run) {
    if (!result.runs[run] || !std::isfinite(result.runs[run]->cost))
      continue;  // it may have no samples
    const StudyCase& now = plan.cases()[plan.caseOf(run)];
    const auto [at, is_new] = first.insert(
        {{plan.loopOf(run), now.scenario, result.runs[run]->trajectory}, plan.caseOf(run)});
    if (!is_new)
      throw InputError("loop " + plan.study().loops[plan.loopOf(run)].name + ": '" +
                       plan.cases()[at->second].name + "' and '" + now.name +
                       "' gave the same trajectory: expected seeds, noise or vary that change it");
  }
}

class StudySession {
 public:
  StudySession(const StudyPlan& plan, const StudyOptions& options, RunPool& pool)
      : plan_(plan),
        options_(options),
        pool_(pool),
        keeps_(pool.leads() && !options.state.empty()),
        journal_(options.state, plan.fingerprint()),
        kept_(std::chrono::steady_clock::now()) {
    result_.runs.resize(plan.runs());
    require(!options.resume || !options.state.empty(), "resume", "a state file to resume from");
    if (!pool.leads()) return;
    if (options.resume) readDone();
    for (const auto& run : result_.runs) result_.resumed += run.has_value();
    done_ = result_.resumed;
  }

  StudyResult take() {
    if (keeps_) begin();
    RunPool::Texts texts(plan_.runs());
    for (std::size_t i = 0; i < texts.size(); ++i)
      if (result_.runs[i]) texts[i] = textOf(*result_.runs[i]);
    pool_.fill(
        texts, open(), [&](std::size_t i) { return work(i); },
        [&](std::size_t i, const std::string& text) { done(i, text); });
    for (std::size_t i = 0; i < texts.size(); ++i)
      if (texts[i]) result_.runs[i] = judgementOf(*texts[i]);
    result_.complete = std::all_of(texts.begin(), texts.end(), [](const auto& t) { return t; });
    if (keeps_) keep();
    if (keeps_ && result_.complete) journal_.remove();
    if (pool_.leads()) requireDifferentCases(plan_, result_);
    return std::move(result_);
  }

 private:
  /// The state file, and what was found after it was written. A study that was killed early has
  /// only the latter.
  void readDone() {
    const auto found = journal_.read();
    if (found.empty() || std::filesystem::exists(options_.state))
      result_.runs = readStudyState(options_.state, plan_.fingerprint(), plan_.runs());
    for (const auto& [run, text] : found)
      if (run < plan_.runs()) result_.runs[run] = judgementOf(text);
  }

  void begin() {
    if (options_.resume)
      keep();
    else
      std::filesystem::remove(options_.state);  // of an older study
    journal_.begin();
  }

  /// Pairs next to each other: what a stopped study holds can be compared.
  std::vector<std::size_t> open() const {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < plan_.runs(); ++i)
      if (!result_.runs[i]) open.push_back(i);
    std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
      return plan_.caseOf(a) < plan_.caseOf(b);
    });
    return open;
  }

  std::optional<std::string> work(std::size_t index) const {
    const auto stopped = [&] { return options_.stop && options_.stop(); };
    if (stopped()) return std::nullopt;
    const RunJudgement judged = judge(index);
    if (stopped()) return std::nullopt;  // it may have been cut short
    return textOf(judged);
  }

  RunJudgement judge(std::size_t index) const {
    RunOptions options;
    options.stop = options_.stop;
    try {
      const LoopFile loop = plan_.loop(index);
      return judgeRun(plan_.study(), loop, runLoop(loop, options));
    } catch (const std::exception& e) {
      return failed(e.what());
    }
  }

  void done(std::size_t index, const std::string& text) {
    if (keeps_) {
      journal_.add(index, text);
      result_.runs[index] = judgementOf(text);
      if (std::chrono::steady_clock::now() - kept_ > kKeepEvery) keep();
    }
    if (options_.progress) options_.progress(++done_, plan_.runs());
  }

  void keep() {
    kept_ = std::chrono::steady_clock::now();
    writeStudyState(options_.state, plan_.fingerprint(), result_.runs);
    journal_.begin();
  }

  const StudyPlan& plan_;
  const StudyOptions& options_;
  RunPool& pool_;
  bool keeps_;
  RunJournal journal_;
  StudyResult result_;
  std::chrono::steady_clock::time_point kept_;
  std::size_t done_{};
};

}  // namespace

StudyResult runStudy(const StudyPlan& plan, const StudyOptions& options) {
  ThreadPool threads(options.threads);
  return StudySession(plan, options, options.pool != nullptr ? *options.pool : threads).take();
}

}  // namespace fpc
