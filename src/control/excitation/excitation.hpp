// Experiments for identification: each input follows a signal of its own that does not depend on
// what the plant does; a plant that is unstable where it is to be known needs feedback beside it
// (ljung1999, sec. 13.4). Pseudo-random binary signals from shift
// registers of maximal length (golomb1967), random levels held for random times, given staircases.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "fmbpc/control/controller.hpp"

namespace fpc {

/// From this sample on, this value.
struct ExcitationStep {
  std::int64_t step{};
  double value{};
};

/// none: the start input.
enum class ExcitationKind { kPrbs, kMultiLevel, kSteps, kNone };
inline std::vector<std::string> wordsOf(ExcitationKind) {
  return {"prbs", "multi_level", "steps", "none"};
}

/// What one input does. Times are in samples.
struct ExcitationSignal {
  int input{};  ///< index
  ExcitationKind signal{ExcitationKind::kNone};
  double lower{}, upper{};     ///< prbs: both levels; multi_level: levels are uniform between them
  std::vector<double> levels;  ///< multi_level: drawn from this list instead
  int clock_steps{1};          ///< prbs: samples per bit
  int hold_lower_steps{1};     ///< multi_level: a level is held for a time that is uniform in
  int hold_upper_steps{1};     ///< hold_lower_steps..hold_upper_steps
  std::vector<ExcitationStep> schedule;  ///< steps: a staircase, samples increasing
};

/// Holds a plant in its range that would not stay there by itself: adds gain * (setpoint - y).
struct ExcitationFeedback {
  int input{}, output{};  ///< indices
  double gain{};          ///< input unit per output unit
};

struct ExcitationParams {
  std::uint64_t seed{1};
  std::vector<ExcitationSignal> signals;     ///< inputs without one keep the start input
  std::vector<ExcitationFeedback> feedback;  ///< empty: an open-loop experiment
  /// @throws InputError naming the field: indices, words, two signals for one input, levels beyond
  /// the bounds of the inputs, times, feedback of an unknown output.
  void validate(const InputLimits& limits, Eigen::Index n_y) const;
};

/// Two levels: the bits of a shift register with feedback, period 2^bits - 1.
class ShiftRegister {
 public:
  static constexpr std::uint32_t kBits = 10, kPeriod = (1U << kBits) - 1U;
  /// `state` is any number; 1..kPeriod are taken as they are.
  explicit ShiftRegister(std::uint64_t state);
  bool next();  ///< the bit that falls out

 private:
  std::uint32_t state_;
};

/// The signal of one input, a function of seed, input and sample only.
class ExcitationStream {
 public:
  ExcitationStream(ExcitationSignal signal, std::uint64_t seed, double start_input);
  /// Value at a sample. Asked in order this takes fixed time; a jump is played through.
  double at(std::uint32_t step);
  int input() const { return signal_.input; }

 private:
  void rewind();
  void next();  // the value after end_
  void nextLevel();

  ExcitationSignal signal_;
  double start_input_;
  std::mt19937_64 first_engine_, engine_;
  ShiftRegister first_register_, register_;
  std::size_t entry_{};           // steps: the next of the schedule
  std::int64_t begin_{}, end_{};  // samples of value_: begin_ <= step < end_
  double value_{};
};

/// u(k) = signal of each input, plus the feedback's share if there is any, clipped to move limit
/// and bounds: where a level is further away than one move, the input walks there; the hold time
/// counts from the choice of the level. Streams are independent: the bits of an input depend on the
/// seed and its own settings only. After a gap, a restart or manual mode the signal is where it
/// would have been. Setpoints have a meaning for feedback only.
class ExcitationController final : public Controller {
 public:
  /// start_input: n_u, the input before sample 0. @throws InputError naming the field.
  ExcitationController(ExcitationParams params, InputLimits limits, Vector start_input,
                       const PlantInfo& plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool followsSetpoint() const override { return !feedback_.empty(); }

 private:
  InputLimits limits_;
  std::vector<ExcitationFeedback> feedback_;
  Vector signal_;  // start input, overwritten by the streams
  Vector unclipped_;
  Vector no_reference_;
  std::vector<ExcitationStream> streams_;
};

}  // namespace fpc
