// fmbpc evaluate RUN...: the benchmark's indices of runs of BSM1, recorded or run here.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/loop/report.hpp"
#include "fmbpc/loop/run.hpp"
#include "fmbpc/study/evaluate.hpp"
#include "tool/commands.hpp"
#include "tool/watched_run.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;

/// A recorded run, or one that is made now.
CsvTable trajectory(const std::string& run, const Overrides& overrides) {
  const fs::path folder(run);
  if (fs::is_regular_file(folder / "trajectory.csv"))
    return readCsv((folder / "trajectory.csv").string());
  if (fs::is_regular_file(folder) && folder.extension() == ".csv") return readCsv(run);
  const LoopFile loop = readLoop(run, overrides);
  ProgressBar bar(loop.name);
  CsvTable table = trajectoryOf(loop, runLoop(loop, watchedBy(bar)));
  table.file = loop.name;
  return table;
}

Json jsonOf(const std::string& run, const EffluentReport& report) {
  Json json{{"run", run},        {"samples", report.samples}, {"days", report.days},
            {"EQI", report.EQI}, {"IQI", report.IQI},         {"AE", report.AE},
            {"PE", report.PE},   {"SP", report.SP},           {"ME", report.ME},
            {"EC", report.EC},   {"OCI", report.OCI},         {"limits", Json::object()}};
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
    "[g/m3] (times crossed);\n95%: percentile of the samples [g/m3] (alex2008)\n";

void printHead() {
  std::printf("%-28s %9s %9s %8s %7s %8s %7s %7s %9s %14s %14s %7s %7s\n", "run", "EQI", "IQI",
              "AE", "PE", "SP", "ME", "EC", "OCI", "TN > 18", "NH > 4", "TN 95%", "NH 95%");
}

void print(const std::string& run, const EffluentReport& r) {
  const LimitIndices &TN = r.limit("TN"), &NH = r.limit("NH");
  std::printf(
      "%-28s %9.1f %9.1f %8.1f %7.1f %8.1f %7.1f %7.1f %9.1f %7.2f %% (%d) %7.2f %% (%d) %7.2f "
      "%7.2f\n",
      run.c_str(), r.EQI, r.IQI, r.AE, r.PE, r.SP, r.ME, r.EC, r.OCI, TN.share_percent,
      TN.crossings, NH.share_percent, NH.crossings, TN.percentile_95, NH.percentile_95);
  for (const char* other : {"COD", "TSS", "BOD"})
    if (r.limit(other).crossings > 0)
      std::printf("  %s above %g: %.2f %% of the time, %d times\n", other, r.limit(other).limit,
                  r.limit(other).share_percent, r.limit(other).crossings);
}

}  // namespace

int evaluate(const EvaluateArguments& arguments) {
  EvaluateParams params{arguments.from_h, arguments.to_h, arguments.weights_2002};
  params.validate();
  Overrides overrides;
  for (const auto& text : arguments.set) overrides.push_back(parseOverride(text));
  Json all = Json::array();
  for (const auto& run : arguments.runs) {
    const EffluentReport report = evaluateEffluent(trajectory(run, overrides), params);
    if (!arguments.json && all.empty()) printHead();
    all.push_back(jsonOf(run, report));
    if (!arguments.json) print(run, report);
  }
  if (!arguments.json && !all.empty()) std::cout << kLegend;
  if (arguments.json) std::cout << (all.size() == 1 ? all[0] : Json{{"runs", all}}).dump(2) << "\n";
  return interruption().load() ? 130 : 0;
}

}  // namespace fpc::tool
