// How often a run was where its model has no data; which inputs a model knows.
#include "runtime/model_use.hpp"

#include <algorithm>

#include "fmbpc/model/domain.hpp"
#include "model/model_inputs.hpp"
#include "model/process_trust.hpp"
#include "runtime/report.hpp"

namespace fpc {

bool hasDomain(const LoopFile& loop) {
  const bool predicts = loop.has_model && loop.controller && loop.controllerType().needs_model;
  return predicts && knowsDomain(loop.model);
}

Rejections::Rejections(const LoopFile& loop) : judge_(loop.plausibility, loop.plant_info) {}

// Where a sample is missing, rates and jumps are counted anew, as the controller does.
void Rejections::look(const SampleRecord& sample) {
  seen_ = sample.has_measurement;
  if (seen_)
    verdict_ = judge_.look(sample.measurement);
  else
    judge_.reset();
}

bool isOutsideModel(const LoopFile& loop, const SampleRecord& sample, const Rejections& rejected) {
  if (!sample.has_measurement || !sample.has_action || rejected.any()) return false;
  const Measurement& m = sample.measurement;
  Vector now(m.outputs.size() + m.input_applied.size() + m.disturbances.size());
  now << m.outputs, m.input_applied, m.disturbances;
  return processTrustOf(loop.model, now) < loop.guard.trust_low;
}

std::uint64_t samplesOutsideModel(const LoopFile& loop, const RunRecord& record) {
  if (!hasDomain(loop)) return 0;
  Rejections rejected(loop);
  return static_cast<std::uint64_t>(
      std::count_if(record.samples.begin(), record.samples.end(), [&](const SampleRecord& sample) {
        rejected.look(sample);
        return isOutsideModel(loop, sample, rejected);
      }));
}

std::vector<bool> movedInputs(const LoopFile& loop) {
  std::vector<bool> moved(loop.plant_info.inputs.size(), true);
  if (!loop.controller) return moved;
  const SignalUse use = loop.controller->signalUse(controllerContext(loop));
  if (use.moved.size() == moved.size()) moved = use.moved;
  if (!loop.controllerType().needs_model || !loop.has_model || loop.has_identify) return moved;
  for (std::size_t i = 0; i < moved.size(); ++i)
    moved[i] = moved[i] && knowsInput(loop.model, static_cast<int>(i));
  return moved;
}

}  // namespace fpc
