// How often may a signal show the same number in a row? Judged from its own noise and resolution.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace fpc {

/// Of the last kWindow steps before a run of equal readings:
///   q        the smallest step, or difference of consecutive ones, that is not 0: the resolution
///   sigma^2  a quarter of minus the mean product of consecutive differences of steps (motion, of
///            which only the bend is left, gives 0 or less), halved since it is an estimate
///   p        erf(q / (2 sqrt(2) sigma)): noise of sigma behind q shows the same number again with
///            at most this probability; or the share of zeros among the steps, if that is larger
/// The run is unlikely once p^repeats < kChance. A signal has noise if that product is between 0.45
/// and 0.85 of the mean square of these differences (white noise: two thirds, a signal that
/// alternates: 1), no difference is a quarter of that sum (a jump, an oscillation that dies out),
/// and eight steps are of two resolutions or more (rounding alone makes none); without noise no run
/// is unlikely. A reading at the largest or the smallest value seen so far may be at a limit, as a
/// flow over a weir. A signal in motion (three quarters of eight steps or more are not 0, the last
/// two go on one way by far more than the grid of its numbers) that shows a number once more was
/// not read anew: the reading is repeated, for kLate samples; what lasts longer is a limit that it
/// has come to.
class FlatLine {
 public:
  static constexpr int kWindow = 64, kFewest = 24, kFirst = 8, kLate = 3;
  static constexpr double kChance = 1e-9;

  void reset() { *this = {}; }
  /// One reading, a number. No allocation.
  void add(double value);
  int repeats() const { return repeats_; }  ///< readings in a row equal to the one before them
  bool isUnlikely() const { return repeats_ >= allowed_; }
  bool isRepeated() const { return moves_ && repeats_ >= 1 && repeats_ <= kLate; }
  bool isAtExtreme() const { return value_ >= largest_ || value_ <= smallest_; }  ///< so far

 private:
  void push(double step);
  double resolution() const;  ///< q; 0: unknown
  double grid() const;        ///< all steps are multiples of it
  double step(int k) const { return steps_[static_cast<std::size_t>((next_ + k) % kWindow)]; }
  int changes() const;
  int allowed() const;
  bool isInMotion() const;

  std::array<double, kWindow> steps_{};  // a ring
  int known_{}, next_{}, repeats_{}, allowed_{std::numeric_limits<int>::max()};
  bool started_{false}, moves_{false};  // moves_: before this run
  double value_{}, largest_{}, smallest_{};
};

}  // namespace fpc
