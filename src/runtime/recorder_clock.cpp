#include "runtime/recorder_clock.hpp"

namespace fpc {

void RecorderClock::hear(double now_s) {
  if (!began_s_) began_s_ = now_s;
}

void RecorderClock::seeFinal(bool final, double now_s) {
  if (!final)
    final_s_.reset();
  else if (!final_s_)
    final_s_ = now_s;
}

void RecorderClock::close(double now_s) {
  if (!closed_s_) closed_s_ = now_s;
}

bool RecorderClock::stragglersLost(double now_s) const {
  return !closed_s_ && final_s_ && now_s - *final_s_ >= kFinalPatience;
}

bool RecorderClock::writingLost(double now_s) const {
  return closed_s_ && now_s - *closed_s_ > kWritePatience;
}

}  // namespace fpc
