// What the recorder says of itself.
#include "ros/loop_recorder.hpp"

namespace fpc {

namespace {
constexpr double kLacking = 1.0;  // [s] in which a late message may come
}

Health LoopRecorder::health(double now_s) const {
  if (!plant_.problem().empty())
    return {LoopMode::kFailed, EventCode::kPlantDiffers, plant_.problem(), {}};
  if (!store_->problem().empty())
    return {LoopMode::kFailed, EventCode::kRecordingFailed, store_->problem(), {}};
  if (!problem_.empty()) return {LoopMode::kFailed, EventCode::kRecordingFailed, problem_, {}};
  if (bag_ && !bag_->problem().empty())
    return {LoopMode::kFailed, EventCode::kRecordingFailed, bag_->problem(), {}};
  if (!ready_.announced())
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for publishers of the exchange", {}};
  if (written_) return {LoopMode::kFinished, EventCode::kNone, "written", {}};
  if (lacks_s_ >= 0 && now_s - lacks_s_ > kLacking)
    return {LoopMode::kDegraded, EventCode::kRecordGap, "recording, with gaps: " + lacks_, {}};
  return {LoopMode::kAutomatic, EventCode::kNone, session_.running() ? "recording" : "waiting", {}};
}

void LoopRecorder::report(Diagnostics::Status& status) const {
  status.add("step", session_.latest().step);
  status.add("samples on disk", store_->samples() - store_->unwritten() - store_->lost());
  status.add("samples that wait for the disk", store_->unwritten());
  status.add("samples lost", store_->lost());
  if (!store_->remark().empty()) status.add("run before", store_->remark());
  status.add("samples with gaps", session_.gapCount() + session_.waiting());
  status.add("dropped: other run", session_.strays());
  status.add("dropped: wrong size or not finite", session_.wrongSize());
  addRefused(status, refused());
  addRefused(status, authority().refused());
}

}  // namespace fpc
