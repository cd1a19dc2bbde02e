#include "fmbpc/base/step_gate.hpp"

namespace fpc {

Arrival StepGate::classify(const StepHeader& header) const {
  if (empty_) return Arrival::kFirst;
  if (header.run_id > last_.run_id) return Arrival::kNewRun;
  if (header.run_id < last_.run_id) return Arrival::kOtherRun;
  if (header.step == last_.step) return Arrival::kRepeat;
  if (header.step < last_.step) return Arrival::kOld;
  return header.step == last_.step + 1 ? Arrival::kNext : Arrival::kGap;
}

Arrival StepGate::pass(const StepHeader& header) {
  const Arrival arrival = classify(header);
  switch (arrival) {
    case Arrival::kRepeat:
      ++counts_.repeated;
      break;
    case Arrival::kOld:
      ++counts_.old;
      break;
    case Arrival::kOtherRun:
      ++counts_.other_run;
      break;
    case Arrival::kGap:
      ++counts_.gaps;
      break;
    case Arrival::kNewRun:
      ++counts_.new_runs;
      break;
    case Arrival::kFirst:
    case Arrival::kNext:
      break;
  }
  if (isNew(arrival)) {
    ++counts_.accepted;
    last_ = header;
    empty_ = false;
  }
  return arrival;
}

}  // namespace fpc
