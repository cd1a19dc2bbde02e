// What a loop makes of its model: where it has no data, and which inputs it moves.
#pragma once

#include "config/loop_file.hpp"
#include "runtime/record.hpp"
#include "supervision/signal_validator.hpp"

namespace fpc {

/// Whether the loop's law predicts with a model that knows its data.
bool hasDomain(const LoopFile& loop);
/// Which measurements of a record its controller rejected: the same judgement once more, without
/// the forecasts of the law, that is, of readings that were not taken anew.
class Rejections {
 public:
  explicit Rejections(const LoopFile& loop);
  void look(const SampleRecord& sample);
  /// In the sample looked at last; signals are outputs, then disturbances.
  bool of(std::size_t signal) const { return seen_ && judge_.doubt(signal) != Doubt::kNone; }
  bool any() const { return seen_ && verdict_ != Verdict::kClean; }

 private:
  SignalValidator judge_;
  bool seen_{false};
  Verdict verdict_{Verdict::kClean};
};
/// Of a loop with a domain: whether outputs or disturbances, as they were measured, are where its
/// model has no data. Inputs beyond theirs are not counted: the bounds allow them; nor is a sample
/// of which a measurement was rejected.
bool isOutsideModel(const LoopFile& loop, const SampleRecord& sample, const Rejections& rejected);
/// Inputs that the loop's controller may move: those of its type, and of a law whose model stays
/// what it is those that the model knows.
std::vector<bool> movedInputs(const LoopFile& loop);

}  // namespace fpc
