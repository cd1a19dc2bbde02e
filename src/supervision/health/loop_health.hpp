// What a record of a control loop tells of its health, and what is the most likely cause.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "supervision/health/harris.hpp"
#include "supervision/health/oscillation.hpp"
#include "supervision/health/sensor_faults.hpp"
#include "supervision/health/step_response.hpp"
#include "supervision/health/valve.hpp"

namespace fpc {

/// Who moved the input of a sample.
enum class LoopDuty : std::uint8_t { kAutomatic, kManual, kFallback, kHeld };

/// One controlled output with the input that controls it, evenly sampled. u[k] is in force from
/// sample k on. NaN: unknown.
struct ControlRecord {
  std::string output, input, unit, input_unit;
  double sample_time_s{1.0};
  std::vector<double> y;
  std::vector<double> setpoint;  ///< empty: the mean of y
  std::vector<double> u;         ///< what the controller asked for; empty: unknown
  std::vector<double> position;  ///< of the valve, where it is measured; else empty
  std::vector<LoopDuty> duty;    ///< empty: automatic throughout
  /// Samples in automatic, by hand, on the fallback and held, where `duty` is not known; empty: not
  /// known either.
  std::vector<std::uint64_t> counts;
  double u_lower{-kInfinity}, u_upper{kInfinity};
  double dead_time_s{kNaN};  ///< NaN: estimated
  StepResponse model;  ///< of a model of this loop at its operating point; empty: none is named

  /// @throws InputError naming the series: none, or of other length than y.
  void validate() const;
};

/// The most likely one thing that is wrong, in the order in which it is looked for.
enum class LoopCause : std::uint8_t {
  kHealthy,
  kUnknown,  ///< too little in automatic, or nothing moves: nothing can be said
  kSensorFrozen,
  kSensorSpikes,
  kStiction,
  kBacklash,
  kAggressiveTuning,
  kOscillatingLoad,
  kAtLimits,
  kSluggishTuning,
  kModelOutOfDate,
};
const char* nameOf(LoopCause cause);    ///< stable word: "stiction"
const char* adviceOf(LoopCause cause);  ///< a sentence without full stop

enum class DeadTimeSource : std::uint8_t { kAssumed, kEstimated, kGiven };
const char* nameOf(DeadTimeSource source);  ///< "assumed"

struct LoopHealth {
  std::string output, input, unit, input_unit;
  double sample_time_s{}, hours{};
  Eigen::Index samples{}, missing{};
  double automatic{}, manual{}, fallback{}, held{};  ///< shares of the samples
  double at_limits{};                                ///< of the automatic ones
  double dead_time_s{kNaN};
  DeadTimeSource dead_time_source{};
  MinimumVariance harris;  ///< of stretches whose setpoint rests; times as the record's
  double error_std{kNaN}, error_mean{kNaN};
  double settling_s{kNaN};      ///< until the error's autocorrelation is 0.2
  double error_under_pi{kNaN};  ///< of a PI tuned for the response, over that of the record
  Oscillation oscillation;      ///< of the error; period in samples
  ValveFit valve;
  SensorFaults sensor;
  StepResponse response;  ///< as the record shows it; empty if it does not
  ModelAge model;
  LoopCause cause{LoopCause::kUnknown};
  std::vector<std::string> remarks;  ///< sentences: why, and what else

  double periodS() const { return oscillation.period * sample_time_s; }
  bool isDaily() const;  ///< it swings with the period of a day or half of one, as loads do
};

/// @throws InputError as ControlRecord::validate().
LoopHealth judgeLoop(const ControlRecord& record);

/// Loops of one plant that oscillate with one period: the one whose own valve or tuning does it is
/// the likely source, the others get an oscillating load. Says so in their remarks.
void relateLoops(std::vector<LoopHealth>& loops);

/// Name and value of each figure, in short numbers: for tables, pages and topics.
std::vector<std::pair<std::string, std::string>> figuresOf(const LoopHealth& health);

}  // namespace fpc
