#include "papers/runs.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <memory>

#include "base/parallel.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/run.hpp"

namespace fpc::tool {
namespace {

struct Done {
  RunRecord record;
  Summary summary;
};

/// @throws InputError unless the run went as asked.
void requireSound(const Summary& summary) {
  require(summary.complete, summary.loop, "a run to the end (" + troubleOf(summary) + ")");
  require(!neverControlled(summary), summary.loop, "actions that are not all held or the fallback");
}

Done run(const std::string& loop, const Overrides& overrides) {
  const LoopFile file = readLoop(loop, overrides);
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

struct SeededRun {
  Summary summary;
  double active{};  // share of the samples with an active bound [%]
};
using Seeded = std::vector<std::unique_ptr<SeededRun>>;  // null: the run failed

SeededRun shortened(const Done& done) {
  double active = 0.0, reports = 0.0;
  for (const auto& sample : done.record.samples) {
    if (!sample.has_report) continue;
    reports += 1.0;
    active += sample.report.active_rows > 0 ? 100.0 : 0.0;
  }
  return {done.summary, reports > 0.0 ? active / reports : notPrinted()};
}

const Seeded& seeded(const std::string& loop) {
  static std::map<std::string, Seeded> all;
  const auto known = all.find(loop);
  if (known != all.end()) return known->second;
  const std::uint64_t first = readLoop(loop).disturbance.pattern.seed;
  Seeded runs(kSeeds);
  std::vector<std::string> trouble(kSeeds);
  parallelFor(runs.size(), 0, [&](std::size_t i) {
    const std::string seed = std::to_string(first + i);
    try {
      runs[i] =
          std::make_unique<SeededRun>(shortened(run(loop, {{"disturbance.pattern.seed", seed}})));
    } catch (const std::exception& e) {
      trouble[i] = loop + ", seed " + seed + ": " + e.what();
    }
  });
  for (auto& text : trouble)
    if (!text.empty()) failures().push_back(std::move(text));
  return all.emplace(loop, std::move(runs)).first->second;
}

template <typename Operation>
Values paired(const Values& a, const Values& b, Operation operation) {
  require(a.count() == b.count(), "values over seeds", "equally many runs of both");
  std::vector<double> values;
  for (std::size_t i = 0; i < a.count(); ++i) values.push_back(operation(a.all()[i], b.all()[i]));
  return values;
}

}  // namespace

const RunRecord& recordOf(const std::string& loop, const Overrides& overrides) {
  return done(loop, overrides).record;
}

const Summary& summaryOf(const std::string& loop, const Overrides& overrides) {
  return done(loop, overrides).summary;
}

Summary freshSummaryOf(const std::string& loop, const Overrides& overrides) {
  return run(loop, overrides).summary;
}

const OutputIndices& indicesOf(const Summary& summary, const std::string& output) {
  const auto& names = summary.output_names;
  const auto at = std::find(names.begin(), names.end(), output);
  require(at != names.end(), summary.loop, "an output " + output);
  return summary.outputs[static_cast<std::size_t>(at - names.begin())];
}

Values overSeeds(const std::string& loop, const OfSummary& what) {
  std::vector<double> values;
  for (const auto& one : seeded(loop)) values.push_back(one ? what(one->summary) : notPrinted());
  return values;
}

Values activeOver(const std::string& loop) {
  std::vector<double> values;
  for (const auto& one : seeded(loop)) values.push_back(one ? one->active : notPrinted());
  return values;
}

Values iseOver(const std::string& loop, const std::string& output) {
  return overSeeds(loop, [&](const Summary& s) { return indicesOf(s, output).ise; });
}

Values ratio(const Values& above, const Values& below) {
  return paired(above, below, std::divides<>());
}

Values difference(const Values& from, const Values& subtracted) {
  return paired(from, subtracted, std::minus<>());
}

const std::vector<std::string>& failedRuns() { return failures(); }

}  // namespace fpc::tool
