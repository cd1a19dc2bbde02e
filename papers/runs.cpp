#include "papers/runs.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <memory>

#include "base/parallel.hpp"
#include "fmbpc/base/input_error.hpp"
#include "papers/settings.hpp"
#include "runtime/run.hpp"

namespace fpc::papers {
namespace {

struct Done {
  RunRecord record;
  Summary summary;
};

std::function<Overrides(const LoopFile&)>& perturbation() {
  static std::function<Overrides(const LoopFile&)> change;
  return change;
}

std::size_t& seedCount() {
  static std::size_t count = 24;
  return count;
}

/// @throws InputError unless the run went as asked.
void requireSound(const Summary& summary) {
  require(summary.complete, summary.loop, "a run to the end (" + troubleOf(summary) + ")");
  require(!neverControlled(summary), summary.loop, "actions that are not all held or the fallback");
}

Done run(const std::string& loop, const Overrides& overrides) {
  const LoopFile file = loopOf(loop, overrides);
  Done done{runLoop(file), {}};
  done.summary = summarize(file, done.record, 0.0);
  requireSound(done.summary);
  return done;
}

const Done& done(const std::string& loop, const Overrides& overrides) {
  static std::map<std::pair<std::string, Overrides>, Done> all;
  const auto key = std::make_pair(loop, overrides);
  const auto known = all.find(key);
  return known != all.end() ? known->second : all.emplace(key, run(loop, overrides)).first->second;
}

std::vector<std::string>& failures() {
  static std::vector<std::string> all;
  return all;
}

RunFigures figuresOf(const Done& done) {
  double active = 0.0, reports = 0.0;
  for (const auto& sample : done.record.samples) {
    if (!sample.has_report) continue;
    reports += 1.0;
    active += sample.report.active_rows > 0 ? 100.0 : 0.0;
  }
  return {done.summary, reports > 0.0 ? active / reports : kNotPrinted};
}

/// What a name stands for: a loop and one set of changes, or several.
struct Named {
  std::string loop;
  std::vector<Overrides> sets{{}};
  std::vector<std::string> variants;  // of several: what each is called
};

Named named(std::string run) {
  Named result;
  const bool seeded = !run.empty() && run.back() == '*';
  if (seeded) run.pop_back();
  std::size_t at = run.find('+');
  result.loop = run.substr(0, at);
  while (at != std::string::npos) {
    const std::size_t next = run.find('+', at + 1);
    const std::string name = run.substr(at + 1, next - at - 1);
    const auto known = settings().find(name);
    require(known != settings().end(), run, "a setting that is known, not " + name);
    std::vector<Overrides> sets;
    for (const Overrides& set : result.sets)
      for (const Overrides& more : known->second) {
        sets.push_back(set);
        sets.back().insert(sets.back().end(), more.begin(), more.end());
      }
    result.sets = std::move(sets);
    at = next;
  }
  if (seeded) {
    require(result.sets.size() == 1, run, "seeds of one set of changes");
    const std::uint64_t first = readLoop(result.loop).disturbance.pattern.seed;
    const Overrides same = result.sets[0];
    result.sets.assign(seeds(), same);
    for (std::size_t i = 0; i < result.sets.size(); ++i)
      result.sets[i].emplace_back("seed", std::to_string(first + i));
  }
  for (std::size_t i = 0; i < result.sets.size() && result.sets.size() > 1; ++i)
    result.variants.push_back(result.sets[i].back().first + " " + result.sets[i].back().second);
  return result;
}

using Many = std::vector<std::unique_ptr<RunFigures>>;  // null: the run failed

const Many& many(const std::string& run, const Named& names) {
  static std::map<std::string, Many> all;
  const auto known = all.find(run);
  if (known != all.end()) return known->second;
  Many runs(names.sets.size());
  std::vector<std::string> trouble(runs.size());
  parallelFor(runs.size(), 0, [&](std::size_t i) {
    try {
      runs[i] = std::make_unique<RunFigures>(figuresOf(papers::run(names.loop, names.sets[i])));
    } catch (const std::exception& e) {
      trouble[i] = run + ", " + names.variants[i] + ": " + e.what();
    }
  });
  for (auto& text : trouble)
    if (!text.empty()) failures().push_back(std::move(text));
  return all.emplace(run, std::move(runs)).first->second;
}

const Done& single(const std::string& run) {
  const Named names = named(run);
  require(names.sets.size() == 1, run, "one run");
  return done(names.loop, names.sets[0]);
}

}  // namespace

const RunRecord& recordOf(const std::string& run) { return single(run).record; }

const RunRecord& recordOf(const std::string& loop, const Overrides& overrides) {
  return done(loop, overrides).record;
}

LoopFile loopOf(const std::string& name, const Overrides& overrides) {
  LoopFile loop = readLoop(name, overrides);
  if (!perturbation()) return loop;
  Overrides all = overrides;
  for (auto& change : perturbation()(loop)) all.push_back(std::move(change));
  return all.size() == overrides.size() ? loop : readLoop(name, all);
}

LoopFile loopOf(const std::string& run) {
  const Named names = named(run);
  require(names.sets.size() == 1, run, "one run");
  return loopOf(names.loop, names.sets[0]);
}

Summary freshSummaryOf(const std::string& loop, const Overrides& overrides) {
  return run(loop, overrides).summary;
}

Values overRuns(const std::string& run, const OfRun& what) {
  const Named names = named(run);
  if (names.sets.size() == 1) return what(figuresOf(single(run)));
  std::vector<double> values;
  for (const auto& one : many(run, names)) values.push_back(one ? what(*one) : kNotPrinted);
  return values;
}

Eigen::Index indexOf(const std::vector<std::string>& names, const std::string& name,
                     const std::string& loop) {
  const auto at = std::find(names.begin(), names.end(), name);
  require(at != names.end(), loop, "a signal " + name);
  return at - names.begin();
}

Eigen::Index indexOf(const std::vector<SignalInfo>& signals, const std::string& name,
                     const std::string& loop) {
  std::vector<std::string> names;
  for (const auto& signal : signals) names.push_back(signal.name);
  return indexOf(names, name, loop);
}

std::size_t seeds() { return seedCount(); }
void setSeeds(std::size_t count) { seedCount() = count; }

const std::vector<std::string>& failedRuns() { return failures(); }

void perturbEachLoop(std::function<Overrides(const LoopFile&)> change) {
  perturbation() = std::move(change);
}

}  // namespace fpc::papers
