// How long is waited for somebody else, in time in which this process runs itself.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Looks so many times within the time-out, and a look that comes late counts as one: what held it
/// up (a machine that stands still, or has much else to do) holds up whoever is waited for as well.
/// Times [s] on a steady clock of the caller's.
class OwnWait {
 public:
  explicit OwnWait(double timeout_s, int looks = 10)
      : between_s_(timeout_s / looks), most_(looks) {}
  void begin(double now_s) {
    looked_s_ = now_s;
    looks_ = 0;
    open_ = true;
  }
  void end() { open_ = false; }
  bool isOpen() const { return open_; }
  /// When to look next; infinite: nothing is waited for.
  double nextLook() const { return open_ ? looked_s_ + between_s_ : kInfinity; }
  /// A look. True: for long enough; begin() or end() follows.
  bool isOver(double now_s) {
    if (now_s < nextLook()) return false;
    looked_s_ = now_s;
    return ++looks_ >= most_;
  }

 private:
  double between_s_;
  int most_, looks_{};
  double looked_s_{};
  bool open_{false};
};

}  // namespace fpc
