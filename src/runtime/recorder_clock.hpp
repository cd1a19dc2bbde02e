// The times of one run as its recorder sees it: how long the run took, and how long is waited at
// its end.
#pragma once

#include <optional>

namespace fpc {

/// Times [s] on a steady clock of the caller's. Pure: time is passed in.
class RecorderClock {
 public:
  static constexpr double kFinalPatience = 10.0;  ///< [s] for stragglers after the final sample
  static constexpr double kWritePatience = 10.0;  ///< [s] for room on the disk at the end

  /// A new run, of which nothing has come yet; or one that is gone on with, begun at `began_s`.
  void restart(std::optional<double> began_s = {}) { *this = RecorderClock(began_s); }
  RecorderClock() = default;

  void hear(double now_s);  ///< something of the run has come
  /// After each measurement: whether the final one has come. A plant may go on after one.
  void seeFinal(bool final, double now_s);
  void close(double now_s);  ///< what there is is written from now on; the first time counts

  double elapsed(double now_s) const { return now_s - began_s_.value_or(now_s); }
  bool closed() const { return closed_s_.has_value(); }
  /// The final sample came long ago, and what belongs to the run is still not there.
  bool stragglersLost(double now_s) const;
  /// What cannot be written yet will not be.
  bool writingLost(double now_s) const;

 private:
  explicit RecorderClock(std::optional<double> began_s) : began_s_(began_s) {}

  std::optional<double> began_s_, final_s_, closed_s_;
};

}  // namespace fpc
