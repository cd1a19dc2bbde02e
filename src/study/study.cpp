#include "fmbpc/study/study.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/parallel.hpp"
#include "fmbpc/loop/run.hpp"
#include "study/study_state.hpp"

namespace fpc {
namespace {

constexpr std::chrono::seconds kKeepEvery{2};  // a state file is not written more often

RunJudgement failed(const std::string& words) {
  RunJudgement run;
  run.cost = run.move = run.least = run.largest_move = std::numeric_limits<double>::infinity();
  run.failures[static_cast<std::size_t>(RunFailure::kDiverged)] = 1;
  run.trouble = words;
  return run;
}

class Session {
 public:
  Session(const StudyPlan& plan, const StudyOptions& options)
      : plan_(plan), options_(options), kept_(std::chrono::steady_clock::now()) {
    result_.runs.resize(plan.runs());
    if (!options.resume) return;
    require(!options.state.empty(), "resume", "a state file to resume from");
    result_.runs = readStudyState(options.state, plan.fingerprint(), plan.runs());
    for (const auto& run : result_.runs) result_.resumed += run.has_value();
    done_ = result_.resumed;
  }

  StudyResult take() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < plan_.runs(); ++i)
      if (!result_.runs[i]) open.push_back(i);
    // Pairs next to each other: what a stopped study holds can be compared.
    std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
      return plan_.caseOf(a) < plan_.caseOf(b);
    });
    parallelFor(open.size(), options_.threads, [&](std::size_t i) { work(open[i]); });
    keep(true);
    result_.complete = done_ == plan_.runs();
    return std::move(result_);
  }

 private:
  void work(std::size_t index) {
    const auto stopped = [&] { return options_.stop && options_.stop(); };
    if (stopped()) return;
    RunJudgement judged = judge(index);
    if (stopped()) return;  // it may have been cut short
    const std::lock_guard<std::mutex> lock(mutex_);
    result_.runs[index] = std::move(judged);
    ++done_;
    if (options_.progress) options_.progress(done_, plan_.runs());
    keep(false);
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

  void keep(bool now) {
    if (options_.state.empty()) return;
    const auto time = std::chrono::steady_clock::now();
    if (!now && time - kept_ < kKeepEvery) return;
    kept_ = time;
    writeStudyState(options_.state, plan_.fingerprint(), result_.runs);
  }

  const StudyPlan& plan_;
  const StudyOptions& options_;
  StudyResult result_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point kept_;
  std::size_t done_{};
};

}  // namespace

StudyResult runStudy(const StudyPlan& plan, const StudyOptions& options) {
  return Session(plan, options).take();
}

}  // namespace fpc
