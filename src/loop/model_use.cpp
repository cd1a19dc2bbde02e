// How often a run was where its model has no data.
#include "loop/model_use.hpp"

#include <algorithm>

#include "fmbpc/fuzzy/domain.hpp"
#include "fmbpc/fuzzy/process_trust.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {

bool hasDomain(const LoopFile& loop) {
  const bool predicts = loop.has_model && loop.controller && loop.controllerType().needs_model;
  return predicts && knowsDomain(loop.model);
}

bool isOutsideModel(const LoopFile& loop, const SampleRecord& sample) {
  if (!sample.has_measurement || !sample.has_action) return false;
  const Measurement& m = sample.measurement;
  Vector now(m.outputs.size() + m.input_applied.size() + m.disturbances.size());
  now << m.outputs, m.input_applied, m.disturbances;
  return processTrustOf(loop.model, now) < loop.guard.trust_low;
}

std::uint64_t samplesOutsideModel(const LoopFile& loop, const RunRecord& record) {
  if (!hasDomain(loop)) return 0;
  return static_cast<std::uint64_t>(
      std::count_if(record.samples.begin(), record.samples.end(),
                    [&](const SampleRecord& sample) { return isOutsideModel(loop, sample); }));
}

}  // namespace fpc
