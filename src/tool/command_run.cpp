// fmbpc run LOOP...: the loop closed in one process.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>

#include "base/files.hpp"
#include "config/command_file.hpp"
#include "config/model_file.hpp"
#include "config/plant_loops.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "runtime/run_plant.hpp"
#include "tool/commands.hpp"
#include "tool/watched_run.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

/// Where the models that a run identifies go, as fuzzy_identifier writes them.
void writeModelFile(const TsModel& model, const std::string& folder) {
  if (folder.empty()) return;
  makeFolder(folder);
  writeText(writeModel(model), inFolder(folder, "model.yaml"));
}

/// A loop that is there for a model: model.identify.after, and no setpoint is followed.
bool isForAModel(const LoopFile& loop, const RunRecord& record) {
  return loop.has_identify && loop.identify.after > 0 && !record.samples.empty() &&
         record.samples.front().tracking.setpoint.array().isNaN().all();
}

/// `failed` becomes true if the loop was there for a model and has none.
Summary runOne(const LoopFile& loop, const std::string& folder, const std::string& commands,
               bool& failed) {
  ProgressBar bar(loop.name);
  RunOptions options = watchedBy(bar);
  if (!commands.empty()) options.commands = readCommands(commands, loop);
  bool identified = false;
  options.identified = [&](const TsModel& model) {
    identified = true;
    writeModelFile(model, folder);
  };
  options.said = [&loop](const Event& event) {
    std::fprintf(stderr, "fmbpc: %s: sample %u: %s: %s\n", loop.name.c_str(), event.first,
                 kindOf(event.code).name, event.text.c_str());
  };
  const auto start = std::chrono::steady_clock::now();
  const RunRecord record = runLoop(loop, options);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  Summary summary = summarize(loop, record, wall.count());
  if (!folder.empty()) writeRun(loop, record, summary, folder);
  summary.slowest_step_s = record.slowest_step_s;  // printed, not kept: it differs every time
  if (isForAModel(loop, record) && !identified && !interruption()) {
    failed = true;
    std::fprintf(stderr, "fmbpc: %s: no model was identified\n", loop.name.c_str());
  }
  return summary;
}

std::vector<LoopFile> readAll(const RunArguments& arguments) {
  Overrides overrides = parseOverrides(arguments.set);
  if (arguments.on_model) overrides.emplace(overrides.begin(), "plant.type", "model");
  std::vector<LoopFile> loops;
  std::set<std::string> names;
  for (const auto& name : arguments.loops) {
    loops.push_back(readLoop(name, overrides));
    require(names.insert(loops.back().name).second, name, "every loop only once");
  }
  return loops;
}

/// Of several runs one picture.
void draw(const std::vector<std::string>& folders, const std::string& out) {
  const PlotResult plot =
      folders.size() == 1 ? drawPlot(out)
                          : drawComparison(folders, (fs::path(out) / "comparison.png").string());
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

std::string jsonOf(const std::vector<Summary>& summaries) {
  if (summaries.size() == 1) return toJson(summaries.front());
  std::string text = "{\"loops\": [\n";
  for (std::size_t i = 0; i < summaries.size(); ++i)
    text += (i ? ",\n" : "") + toJson(summaries[i]);
  return text + "\n]}";
}

/// True if a plant could not be moved or a controller never acted; says which.
bool reportTrouble(const std::vector<Summary>& summaries) {
  bool any = false;
  for (const auto& summary : summaries) {
    std::string words = troubleOf(summary);
    if (words.empty() && neverControlled(summary))
      words = summary.loop + ": the controller never acted: every sample was held";
    if (!words.empty()) std::fprintf(stderr, "fmbpc: %s\n", words.c_str());
    any = any || !words.empty();
  }
  return any;
}

}  // namespace

namespace {

/// All loops of a plant at once, each into a folder of its name.
int runWholePlant(const RunArguments& arguments) {
  const Overrides overrides = parseOverrides(arguments.set);
  const PlantLoops plant = readPlantLoops(arguments.plant, overrides);
  catchInterrupts();
  RunOptions options;
  options.stop = [] { return interruption() != 0; };
  const auto start = std::chrono::steady_clock::now();
  const std::vector<RunRecord> records = runPlant(plant, options);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  std::vector<Summary> summaries;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LoopFile& loop = plant.loops[i].loop;
    summaries.push_back(summarize(loop, records[i], wall.count()));
    if (arguments.out.empty()) continue;
    const std::string folder = (fs::path(arguments.out) / plant.loops[i].name).string();
    writeRun(loop, records[i], summaries.back(), folder);
    if (!arguments.no_plot && !interruption()) draw({folder}, folder);
  }
  std::cout << (arguments.json ? jsonOf(summaries) + "\n" : toTable(summaries));
  if (interruption()) return kInterrupted;
  return reportTrouble(summaries) ? 1 : 0;
}

}  // namespace

int run(const RunArguments& arguments) {
  if (!arguments.plant.empty()) return runWholePlant(arguments);
  const std::vector<LoopFile> loops = readAll(arguments);
  catchInterrupts();
  std::vector<Summary> summaries;
  std::vector<std::string> written;
  bool failed = false;
  for (const auto& loop : loops) {
    std::string folder = arguments.out;
    if (!folder.empty() && loops.size() > 1) folder = (fs::path(folder) / loop.name).string();
    summaries.push_back(runOne(loop, folder, arguments.commands, failed));
    if (!folder.empty()) written.push_back(folder);
    if (interruption()) break;
  }
  if (!written.empty() && !arguments.no_plot && !interruption()) draw(written, arguments.out);
  std::cout << (arguments.json ? jsonOf(summaries) + "\n" : toTable(summaries));
  if (!arguments.json)
    for (const auto& folder : written) std::cout << "written: " << folder << "\n";
  if (!arguments.json && !interruption()) printVerdict(summaries);
  if (!interruption()) return reportTrouble(summaries) || failed ? 1 : 0;
  std::fprintf(stderr, "fmbpc: interrupted after %u steps\n", summaries.back().steps);
  return kInterrupted;
}

}  // namespace fpc::tool
