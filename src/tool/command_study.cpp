// fmbpc study: loops compared in pairs over seeds, parameters, noise and records.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/files.hpp"
#include "base/near_names.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/plot.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/study_report.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

bool isStudy(const std::string& name) {
  const auto known = studyNames();
  if (std::find(known.begin(), known.end(), name) != known.end()) return true;
  std::ifstream stream(name);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("loops:", 0) == 0) return true;
  return false;
}

/// One name may be a study's or a loop's, and a misspelt one may have meant either.
void requireStudyOrLoop(const std::string& name) {
  const fs::path path(name);
  if (name.find('/') != std::string::npos || path.extension() == ".yaml")
    return require(fs::is_regular_file(path), name, "an existing file of a study or a loop");
  auto known = studyNames();
  for (auto& loop : loopNames()) known.push_back(std::move(loop));
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw InputError(
      "study or loop '" + name + "': expected a path or a name from config/study or config/loop" +
      nearNames(name, known, std::string(kLoopsListsThem) + "; studies: " + join(studyNames())));
}

/// "H=0.001"
std::pair<std::string, double> parseNoise(const std::string& text) {
  const auto [output, value] = parseOverride(text);
  char* end = nullptr;
  const double std = std::strtod(value.c_str(), &end);
  require(!value.empty() && *end == '\0', "--noise", "OUTPUT=STD; got '" + text + "'");
  return {output, std};
}

StudyFile fromOptions(const StudyArguments& arguments) {
  StudyFile study;
  for (const auto& name : arguments.names) {
    study.loops.push_back({name, name, {}});
    study.text += name + "\n";
  }
  study.against = study.loops.back().name;
  FitnessTerm term;
  term.index = arguments.index.empty() ? "ise" : arguments.index;
  study.fitness.terms = {term};
  study.text += term.index;
  return study;
}

/// The options over the study file.
void layOver(const StudyArguments& arguments, StudyFile& study) {
  for (auto& override : parseOverrides(arguments.set)) study.set.push_back(std::move(override));
  for (const auto& text : arguments.vary) study.vary.push_back(parseVariation(text));
  for (const auto& text : arguments.noise) study.noise.push_back(parseNoise(text));
  if (arguments.noise_percent >= 0.0) study.noise_percent = arguments.noise_percent;
  if (!arguments.seeds.empty()) study.seeds = parseSeeds(arguments.seeds, "--seeds");
  if (!arguments.against.empty()) study.against = arguments.against;
  for (const auto* list : {&arguments.vary, &arguments.noise})
    for (const auto& text : *list) study.text += "\n" + text;
  study.text += "\n" + arguments.seeds + " " + exactText(study.noise_percent);
}

StudyResult runWithBar(const StudyPlan& plan, const StudyArguments& arguments) {
  StudyOptions options;
  options.threads = arguments.threads;
  options.pool = arguments.pool.get();
  if (!arguments.out.empty()) options.state = inFolder(arguments.out, "state.json");
  options.resume = arguments.resume;
  options.stop = [] { return interruption().load(); };
  ProgressBar bar("study");
  options.progress = [&](std::size_t done, std::size_t runs) {
    bar.show(static_cast<double>(done) / static_cast<double>(runs),
             std::to_string(done) + " of " + std::to_string(runs) + " runs");
  };
  return runStudy(plan, options);
}

void write(const StudyArguments& arguments, const StudyPlan& plan, const StudyResult& result,
           const StudyStatistics& statistics) {
  writeText(toJson(plan, result, statistics).dump(2) + "\n", inFolder(arguments.out, "study.json"));
  writeRuns(plan, result, inFolder(arguments.out, "runs.csv"));
  if (arguments.no_plot || !result.complete) return;
  const PlotResult plot = drawStudy(arguments.out);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

/// True if a loop has no run to judge; says which, and why its first run failed.
bool reportTrouble(const StudyStatistics& statistics) {
  bool any = false;
  for (const LoopStatistics& loop : statistics.loops) {
    if (!noneSucceeded(loop)) continue;
    any = true;
    std::fprintf(stderr, "fmbpc: %s: none of %zu runs succeeded; %s: %s\n", loop.name.c_str(),
                 loop.runs, loop.failing_cases.front().c_str(), loop.trouble.c_str());
  }
  return any;
}

}  // namespace

StudyFile studyOf(const StudyArguments& arguments) {
  require(!arguments.names.empty(), "study", "a study file or loops");
  const bool from_file = arguments.names.size() == 1 && isStudy(arguments.names.front());
  if (arguments.names.size() == 1 && !from_file) requireStudyOrLoop(arguments.names.front());
  require(!from_file || arguments.index.empty(), "--index", "no study file beside it");
  StudyFile study = from_file ? readStudy(arguments.names.front()) : fromOptions(arguments);
  layOver(arguments, study);
  return study;
}

int study(const StudyArguments& arguments) {
  require(!arguments.resume || !arguments.out.empty(), "--resume", "--out with a stopped study");
  const StudyPlan plan(studyOf(arguments));
  const bool leads = !arguments.pool || arguments.pool->leads();
  if (leads && !arguments.out.empty()) makeFolder(arguments.out);
  catchInterrupts();
  const StudyResult result = runWithBar(plan, arguments);
  if (!leads) return result.complete ? 0 : kInterrupted;
  const StudyStatistics statistics = statisticsOf(plan, result);
  if (!arguments.out.empty()) write(arguments, plan, result, statistics);
  if (arguments.json)
    std::cout << toJson(plan, result, statistics).dump(2) << "\n";
  else
    std::cout << toTable(plan, result, statistics);
  if (result.complete) return reportTrouble(statistics) ? 1 : 0;
  std::fprintf(stderr, "fmbpc: interrupted%s\n",
               arguments.out.empty() ? "" : "; --resume goes on with what is in --out");
  return kInterrupted;
}

}  // namespace fpc::tool
