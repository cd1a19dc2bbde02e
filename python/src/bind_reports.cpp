// Many runs, and analyses: what the tool prints as JSON.
#include <atomic>
#include <memory>
#include <mutex>

#include "bind.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "runtime/commissioning/commissioning.hpp"
#include "study/study.hpp"
#include "study/study_statistics.hpp"
#include "study/tune.hpp"
#include "tool/commands.hpp"
#include "tool/stability_report.hpp"
#include "tool/study_report.hpp"
#include "tool/tune_report.hpp"
#include "watch.hpp"

namespace fpc::python {
namespace {

[[noreturn]] void interruptedBy() {
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

std::string studyHere(const tool::StudyArguments& a, py::object progress) {
  Watch watch(std::move(progress), false);
  std::string json;
  bool complete = false;
  watch.during([&] {
    const StudyPlan plan(tool::studyOf(a));
    std::mutex one;  // stop is called from several threads
    StudyOptions options;
    options.threads = a.threads;
    std::atomic<double> share{0.0};
    std::atomic<bool> stopped{false};
    options.stop = [&stopped] { return stopped.load(); };
    options.progress = [&](std::size_t done, std::size_t runs) {
      const std::lock_guard<std::mutex> lock(one);
      if (!watch.goOn(static_cast<double>(done) / static_cast<double>(runs))) stopped = true;
    };
    const StudyResult result = runStudy(plan, options);
    complete = result.complete;
    json = tool::toJson(plan, result, statisticsOf(plan, result)).dump();
  });
  if (!complete) interruptedBy();
  return json;
}

std::string tuneHere(const std::string& loop, const std::string& file,
                     const std::vector<std::string>& set, const std::string& method,
                     int evaluations, std::int64_t seed, int threads, py::object progress) {
  Watch watch(std::move(progress), false);
  std::string json;
  bool stopped = false;
  watch.during([&] {
    const TuningFile tuning = readTuning(file);
    SearchParams search = tuning.search;
    if (!method.empty()) search.method = searchMethod(method);
    if (evaluations > 0) search.evaluations = evaluations;
    if (seed >= 0) search.seed = static_cast<std::uint64_t>(seed);
    search.validate();
    const TuningObjective objective(loop, tuning, parseOverrides(set),
                                    std::make_shared<ThreadPool>(threads));
    TuneOptions options;
    std::atomic<bool> ended{false};
    options.stop = [&ended] { return ended.load(); };
    options.progress = [&](int n, double) {
      if (!watch.goOn(static_cast<double>(n) / search.evaluations)) ended = true;
    };
    tool::TunedLoop tuned{loop, fpc::tune(objective, search, options), {}};
    stopped = tuned.result.stopped;
    if (tuned.result.best >= 0 && !stopped && !objective.tuning().held_out.empty())
      tuned.held_out = objective.judgeHeldOut(
          tuned.result.history[static_cast<std::size_t>(tuned.result.best)].shares, options.stop);
    json = tool::toJson(objective, tuned).dump();
  });
  if (stopped) interruptedBy();
  return json;
}

std::string commissionHere(const std::string& brief, const std::string& folder,
                           const std::string& until, const std::string& again, int evaluations,
                           int members, int threads, py::object progress) {
  struct Interrupted {};
  Watch watch(std::move(progress), false);
  std::string json;
  bool stopped = false;
  watch.during([&] {
    const auto last = commissioningStage(until, "until");
    CommissioningOptions options;
    options.evaluations = evaluations;
    options.members = members;
    options.threads = threads;
    options.show = [&](CommissioningStage stage, const std::string& text) {
      const double share = static_cast<double>(stage) / kCommissioningStages;
      if (!watch.goOn(share, wordOf(stage) + ": " + text)) throw Interrupted{};
    };
    Commissioning commissioning(brief, folder, options);
    if (!again.empty()) commissioning.undo(commissioningStage(again, "again"));
    try {
      commissioning.run(last);
    } catch (const Interrupted&) {
      stopped = true;
    }
    json = commissioning.figures().dump();
  });
  if (stopped) interruptedBy();
  return json;
}

}  // namespace

void bindReports(py::module_& m) {
  m.def("study", [](std::vector<std::string> names, std::vector<std::string> set,
                    std::vector<std::string> vary, std::vector<std::string> noise,
                    double noise_percent, const std::string& seeds, const std::string& against,
                    const std::string& index, int threads, py::object progress) {
    tool::StudyArguments a;
    a.names = std::move(names);
    a.set = std::move(set);
    a.vary = std::move(vary);
    a.noise = std::move(noise);
    a.noise_percent = noise_percent;
    a.seeds = seeds;
    a.against = against;
    a.index = index;
    a.threads = threads;
    return studyHere(a, std::move(progress));
  });
  m.def("tune", &tuneHere);
  m.def("commission", &commissionHere);
  m.def("stability",
        [](const std::string& name, std::vector<std::string> set, const std::string& at,
           const std::string& horizon, double noise_gain, int settling, int points, bool on_model) {
          tool::StabilityArguments a;
          a.name = name;
          a.set = std::move(set);
          a.at = at;
          a.horizon = horizon;
          a.noise_gain = noise_gain;
          a.settling = settling;
          a.points = points;
          a.on_model = on_model;
          return withoutGil([&] { return tool::stabilityReport(a).dump(); });
        });
}

}  // namespace fpc::python
