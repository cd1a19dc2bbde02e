#include "runtime/late_lines.hpp"

#include <algorithm>

#include "fmbpc/base/text.hpp"
#include "runtime/remark_lines.hpp"

namespace fpc {
namespace {

constexpr double kSeen = 0.05;  // of a sample: less of an input's effect is none

/// The least lag of an input in the model of this output; -1: none acts on it.
int leastInputLag(const OutputModel& output) {
  int least = -1;
  for (const Regressor& r : output.regressors)
    if (r.kind == SignalKind::kInput) least = least < 0 ? r.lag : std::min(least, r.lag);
  return least;
}

}  // namespace

// What u(k) does is in y(k + 1 + lag) of the model, and cannot be seen before its line lets it by.
std::string lateLines(const LoopFile& loop, const std::vector<double>& delays_s) {
  std::string lines;
  if (!loop.has_model || !loop.controller || !loop.controllerType().needs_model) return lines;
  const TsModel& model = loop.model;
  for (std::size_t i = 0; i < std::min(delays_s.size(), model.submodels.size()); ++i) {
    const int lag = leastInputLag(model.submodels[i]);
    const double expected_s = (lag + 1) * model.sample_time_s;
    if (lag < 0 || delays_s[i] < expected_s - kSeen * model.sample_time_s) continue;
    lines =
        joinedLines(lines, model.outputs[i].name + " shows an input only after " +
                               shortText(delays_s[i]) + " s (tf.sample_lines), where model '" +
                               model.name + "' expects it within " + shortText(expected_s) + " s");
  }
  return lines;
}

}  // namespace fpc
