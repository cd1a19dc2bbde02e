// fmbpc evaluate RUN...: the benchmark's indices of runs of BSM1, recorded or run here.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>

#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "study/evaluate.hpp"
#include "tool/commands.hpp"
#include "tool/watched_run.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;

/// What is judged, and what is to be said of it.
struct EvaluatedRun {
  CsvTable table;
  bool complete{true};
  std::vector<std::string> remarks;
};

constexpr const char* kIncomplete =
    "the run is not complete, or its plant could not be moved throughout: no figures of the "
    "benchmark";

/// Of a recording nothing can be changed any more.
void requireNoOverrides(const std::string& run, const Overrides& overrides) {
  require(overrides.empty(), "--set", "a loop that is run now; '" + run + "' is a recording here");
}

EvaluatedRun recorded(const std::string& file) {
  EvaluatedRun judged{readCsv(file), true, {}};
  const fs::path summary = fs::path(file).parent_path() / "summary.json";
  if (fs::is_regular_file(summary)) judged.complete = readSummary(summary.string()).complete;
  return judged;
}

EvaluatedRun runNow(const std::string& run, const Overrides& overrides) {
  const LoopFile loop = readLoop(run, overrides);
  ProgressBar bar(loop.name);
  const RunRecord record = runLoop(loop, watchedBy(bar));
  EvaluatedRun judged{trajectoryOf(loop, record), record.complete, {}};
  judged.table.file = loop.name;
  if (!record.trouble.empty()) judged.remarks.push_back(record.trouble);
  return judged;
}

/// A recorded run, or one that is made now.
EvaluatedRun judgedRun(const std::string& run, const Overrides& overrides) {
  const fs::path folder(run);
  if (fs::is_regular_file(folder / "trajectory.csv")) {
    requireNoOverrides(run, overrides);
    return recorded((folder / "trajectory.csv").string());
  }
  if (fs::is_regular_file(folder) && folder.extension() == ".csv") {
    requireNoOverrides(run, overrides);
    return recorded(run);
  }
  return runNow(run, overrides);
}

/// The benchmark judges 672 samples of 15 minutes.
void addProtocol(const EffluentReport& report, std::vector<std::string>& remarks) {
  if (std::abs(report.days - 7.0) < 0.01 && std::abs(report.sample_min - 15.0) < 0.1) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "judged are %.3g d in samples of %.3g min; the benchmark's figures are of 7 d in "
                "samples of 15 min",
                report.days, report.sample_min);
  remarks.emplace_back(text);
}

Json jsonOf(const std::string& run, const EffluentReport& report, const EvaluatedRun& judged) {
  Json json{{"run", run},
            {"complete", judged.complete},
            {"class", wordOf(report.levers)},
            {"remarks", judged.remarks},
            {"samples", report.samples},
            {"days", report.days},
            {"EQI", report.EQI},
            {"IQI", report.IQI},
            {"AE", report.AE},
            {"PE", report.PE},
            {"SP", report.SP},
            {"ME", report.ME},
            {"EC", report.EC},
            {"OCI", report.OCI},
            {"limits", Json::object()}};
  for (const auto& limit : report.limits)
    json["limits"][limit.name] = {{"limit", limit.limit},
                                  {"share_percent", limit.share_percent},
                                  {"crossings", limit.crossings},
                                  {"percentile_95", limit.percentile_95},
                                  {"mean", limit.mean}};
  return json;
}

constexpr const char* kLegend =
    "EQI, IQI: effluent and influent quality [kg/d]; AE, PE, ME: aeration, pumping, mixing energy "
    "[kWh/d]; SP: sludge to be disposed "
    "of [kg/d];\nEC: external carbon [kg COD/d]; OCI: operational cost index; TN > 18, NH > 4: "
    "share of the time above that limit "
    "[g/m3] (times crossed);\n95%: percentile of the samples [g/m3] (alex2008)\n"
    "class: A with the benchmark's Qr and Qw, no carbon and KLa of at most 240 1/d; B with another "
    "Qr, Qw, or carbon\n";

constexpr const char* kMixed =
    "classes are mixed here: what less sludge, carbon or larger blowers give is no merit of a law; "
    "compare within a class\n";

void printHead() {
  std::printf("%-28s %-12s %9s %9s %8s %7s %8s %7s %7s %9s %14s %14s %7s %7s\n", "run", "class",
              "EQI", "IQI", "AE", "PE", "SP", "ME", "EC", "OCI", "TN > 18", "NH > 4", "TN 95%",
              "NH 95%");
}

void print(const std::string& run, const EffluentReport& r) {
  const LimitIndices &TN = r.limit("TN"), &NH = r.limit("NH");
  std::printf(
      "%-28s %-12s %9.1f %9.1f %8.1f %7.1f %8.1f %7.1f %7.1f %9.1f %7.2f %% (%d) %7.2f %% (%d) "
      "%7.2f "
      "%7.2f\n",
      run.c_str(), wordOf(r.levers).c_str(), r.EQI, r.IQI, r.AE, r.PE, r.SP, r.ME, r.EC, r.OCI,
      TN.share_percent, TN.crossings, NH.share_percent, NH.crossings, TN.percentile_95,
      NH.percentile_95);
  for (const char* other : {"COD", "TSS", "BOD"})
    if (r.limit(other).crossings > 0)
      std::printf("  %s above %g: %.2f %% of the time, %d times\n", other, r.limit(other).limit,
                  r.limit(other).share_percent, r.limit(other).crossings);
}

}  // namespace

int evaluate(const EvaluateArguments& arguments) {
  EvaluateParams params{arguments.from_h, arguments.to_h, arguments.weights_2002};
  params.validate();
  const Overrides overrides = parseOverrides(arguments.set);
  Json all = Json::array();
  std::set<Levers> levers;
  bool complete = true;
  for (const auto& run : arguments.runs) {
    EvaluatedRun judged = judgedRun(run, overrides);
    const EffluentReport report = evaluateEffluent(judged.table, params);
    addProtocol(report, judged.remarks);
    if (!judged.complete) std::fprintf(stderr, "fmbpc: %s: %s\n", run.c_str(), kIncomplete);
    complete = complete && judged.complete;
    if (!arguments.json && all.empty()) printHead();
    all.push_back(jsonOf(run, report, judged));
    levers.insert(report.levers);
    if (arguments.json) continue;
    print(run, report);
    for (const auto& remark : judged.remarks) std::cout << "  " << remark << "\n";
  }
  if (!arguments.json && !all.empty()) std::cout << kLegend << (levers.size() > 1 ? kMixed : "");
  if (arguments.json) std::cout << (all.size() == 1 ? all[0] : Json{{"runs", all}}).dump(2) << "\n";
  if (interruption()) return kInterrupted;
  return complete ? 0 : 1;
}

}  // namespace fpc::tool
