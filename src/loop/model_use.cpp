// How often a run was where its model has no data.
#include <algorithm>

#include "fmbpc/fuzzy/domain.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {
namespace {

bool predicts(const LoopFile& loop) {
  return loop.has_model && loop.controller && loop.controllerType().needs_model;
}

}  // namespace

std::uint64_t samplesOutsideModel(const LoopFile& loop, const RunRecord& record) {
  if (!predicts(loop) || !knowsDomain(loop.model)) return 0;
  std::uint64_t count = 0;
  for (const auto& sample : record.samples) {
    if (!sample.has_measurement || !sample.has_action) continue;
    const Measurement& m = sample.measurement;
    Vector now(m.outputs.size() + m.input_applied.size() + m.disturbances.size());
    now << m.outputs, m.input_applied, m.disturbances;
    Vector next = now;
    next.segment(m.outputs.size(), m.input_applied.size()) = sample.action.input;
    const double trust = std::min(trustOf(loop.model, now), trustOf(loop.model, next));
    count += trust < loop.guard.trust_low;
  }
  return count;
}

}  // namespace fpc
