#include "tool/reproduce/runs.hpp"

#include <algorithm>
#include <map>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/loop/run.hpp"

namespace fpc::tool {
namespace {

struct Done {
  RunRecord record;
  Summary summary;
};

/// A run that throws or does not end well leaves nothing behind.
const Done& done(const std::string& loop, const Overrides& overrides) {
  static std::map<std::pair<std::string, Overrides>, Done> all;
  const auto found = all.find({loop, overrides});
  if (found != all.end()) return found->second;
  const LoopFile file = readLoop(loop, overrides);
  Done run{runLoop(file), {}};
  run.summary = summarize(file, run.record, 0.0);
  require(run.record.complete, loop, "a run to the end (" + troubleOf(run.summary) + ")");
  return all[{loop, overrides}] = std::move(run);
}

}  // namespace

const RunRecord& recordOf(const std::string& loop, const Overrides& overrides) {
  return done(loop, overrides).record;
}

const Summary& summaryOf(const std::string& loop, const Overrides& overrides) {
  return done(loop, overrides).summary;
}

const OutputIndices& indicesOf(const Summary& summary, const std::string& output) {
  const auto& names = summary.output_names;
  const auto at = std::find(names.begin(), names.end(), output);
  require(at != names.end(), summary.loop, "an output " + output);
  return summary.outputs[static_cast<std::size_t>(at - names.begin())];
}

}  // namespace fpc::tool
