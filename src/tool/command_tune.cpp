// fmbpc tune LOOP TUNING: numbers of a loop file found by search.
#include <cstdio>
#include <iostream>

#include "base/files.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/plot.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/tune_report.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

SearchParams searchOf(const TuneArguments& arguments, const TuningFile& tuning) {
  SearchParams search = tuning.search;
  if (!arguments.method.empty()) search.method = searchMethod(arguments.method);
  if (arguments.population != -1) search.population = arguments.population;
  if (arguments.evaluations != -1) search.evaluations = arguments.evaluations;
  if (arguments.seed != -1) {
    require(arguments.seed >= 0, "--seed", "an integer >= 0");
    search.seed = static_cast<std::uint64_t>(arguments.seed);
  }
  search.validate();
  return search;
}

void draw(const TuneArguments& arguments) {
  if (arguments.out.empty() || arguments.no_plot) return;
  const PlotResult plot = drawTuning(arguments.out);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

int interrupted(const TuneArguments& arguments) {
  std::fprintf(stderr, "fmbpc: interrupted%s\n",
               arguments.out.empty() ? "" : "; --resume goes on with what is in --out");
  return kInterrupted;
}

int compare(const TuneArguments& arguments, const TuningObjective& objective,
            const SearchParams& search) {
  require(arguments.seeds >= 1, "--seeds", "an integer >= 1");
  const auto all = searchMethods();
  CompareOptions options{arguments.loop,  search,        arguments.methods,
                         arguments.seeds, arguments.out, arguments.resume};
  if (options.methods.empty()) {
    options.methods = all;
    if (!missingMethods().empty() && objective.pool().leads())
      std::fprintf(stderr, "fmbpc: warning: %s\n", missingMethods().c_str());
  }
  for (const auto& method : options.methods) {
    SearchParams tried = search;
    tried.method = searchMethod(method);
    tried.validate();
  }
  const Json comparison = compareMethods(objective, options);
  if (!objective.pool().leads()) return comparison["complete"] ? 0 : kInterrupted;
  if (!arguments.out.empty())
    writeText(comparison.dump() + "\n", inFolder(arguments.out, "compare.json"));
  if (!comparison["complete"]) return interrupted(arguments);
  draw(arguments);
  if (arguments.json) {
    std::cout << comparison.dump(2) << "\n";
  } else {
    std::cout << comparisonTable(comparison);
  }
  return 0;
}

int tuneOnce(const TuneArguments& arguments, const TuningObjective& objective,
             const SearchParams& search) {
  TuneOptions options;
  if (!arguments.out.empty()) options.state = inFolder(arguments.out, "state.json");
  options.resume = arguments.resume;
  options.stop = [] { return interruption().load(); };
  TunedLoop tuned{arguments.loop, {}, {}};
  {
    ProgressBar bar(wordOf(search.method));
    options.progress = [&](int n, double best) {
      bar.show(static_cast<double>(n) / search.evaluations, "cost " + shortText(best));
    };
    tuned.result = fpc::tune(objective, search, options);
  }
  const TuneResult& result = tuned.result;
  if (result.best >= 0 && !result.stopped && !objective.tuning().held_out.empty())
    tuned.held_out = objective.judgeHeldOut(
        result.history[static_cast<std::size_t>(result.best)].shares, options.stop);
  const auto check = [&] {
    require(result.best >= 0, arguments.loop, "a run that does not fail: " + result.trouble);
  };
  const std::string verdict = verdictOf(objective, tuned);
  const int code = verdict.empty() ? 0 : kTunedWorse;
  if (!objective.pool().leads()) {
    if (!result.stopped) check();
    return result.stopped ? kInterrupted : code;
  }
  const Json json = toJson(objective, tuned);
  std::string file;
  if (!arguments.out.empty()) {
    writeHistory(objective.tuning(), result, inFolder(arguments.out, "history.csv"));
    writeText(json.dump(2) + "\n", inFolder(arguments.out, "tuning.json"));
    if (result.best >= 0 && nothingFound(objective, result).empty())
      file = writeTunedLoop(objective, tuned, arguments.out);
  }
  std::cout << (arguments.json ? json.dump(2) + "\n" : toTable(objective, tuned));
  if (interruption() || result.stopped) return interrupted(arguments);
  draw(arguments);
  if (!arguments.json && !file.empty()) std::cout << "written: " << file << "\n";
  check();
  if (code != 0) std::fprintf(stderr, "fmbpc: %s: %s\n", arguments.loop.c_str(), verdict.c_str());
  return code;
}

}  // namespace

int tune(const TuneArguments& arguments) {
  const TuningFile tuning = readTuning(arguments.tuning);
  const SearchParams search = searchOf(arguments, tuning);
  require(!arguments.resume || !arguments.out.empty(), "--resume", "--out with a stopped tuning");
  const Overrides overrides = parseOverrides(arguments.set);
  const auto pool =
      arguments.pool ? arguments.pool : std::make_shared<ThreadPool>(arguments.threads);
  const TuningObjective objective(arguments.loop, tuning, overrides, pool);
  if (pool->leads() && !arguments.out.empty()) makeFolder(arguments.out);
  catchInterrupts();
  return arguments.compare ? compare(arguments, objective, search)
                           : tuneOnce(arguments, objective, search);
}

}  // namespace fpc::tool
