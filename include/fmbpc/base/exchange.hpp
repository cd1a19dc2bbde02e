// What travels round the loop. Each struct mirrors the message of the same name (msg/), field for
// field; arrays follow the order of PlantInfo. In one process the same structs are handed over
// directly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Identity of a sample: time [ns] = t0 + step * sample time, both integers.
struct StepHeader {
  std::int64_t time_ns{};
  std::uint64_t run_id{};  ///< new, and larger, at each plant start or reset
  std::uint32_t step{};
};

/// One signal of the plant: its name, unit and range in that unit.
struct SignalInfo {
  std::string name;
  std::string unit;
  double lower{};
  double upper{};
};

/// What a controller may know of a plant before the first sample.
struct PlantInfo {
  StepHeader header;  ///< of sample 0
  std::string name;
  std::string frame_id;
  double sample_time_s{};
  std::vector<SignalInfo> outputs;
  std::vector<SignalInfo> inputs;
  std::vector<SignalInfo> disturbances;
  std::vector<std::string> output_frames;  ///< tf frame of the analyser of each output
};

/// Sample k as the controller sees it. `input_applied` is u(k-1), after the actuator.
struct Measurement {
  StepHeader header;
  Vector outputs;        ///< n_y
  Vector disturbances;   ///< n_d, the measured ones
  Vector input_applied;  ///< n_u
  bool final{};          ///< the last sample: no action is expected
};

/// Where an input came from.
enum class ActionSource : std::uint8_t {
  kBase = 1,         ///< the control law, inside its limits
  kConstrained = 2,  ///< the constraint optimizer
  kClipped = 3,      ///< the law or the optimizer had to be clipped
  kHeld = 4,         ///< data missing or not finite: the last applied input
  kManual = 5,       ///< a person
  kFallback = 6,     ///< the configured fallback
  kGuarded = 7,      ///< law or optimizer inside what the guard leaves of the limits
};

/// u(k), acting on [t_k, t_k + Ts).
struct ControlAction {
  StepHeader header;
  Vector input;  ///< n_u
  ActionSource source{ActionSource::kHeld};
};

/// The local model and law of sample k, frozen over n_c samples:
///   x(k+i+1) = A x(k+i) + B u(k+i) + offset_state,   y(k+i) = C x(k+i) + offset_output,
///   u_base(k+i) = -K x(k+i) + feedforward.col(i), absolute units.
struct PredictiveAction {
  StepHeader header;
  Vector state;                       ///< n_x, x(k)
  Matrix A;                           ///< n_x n_x
  Matrix B;                           ///< n_x n_u
  Matrix C;                           ///< n_y n_x
  Vector offset_state;                ///< n_x
  Vector offset_output;               ///< n_y
  Matrix K;                           ///< n_u n_x
  Matrix feedforward;                 ///< n_u n_c
  Matrix reference;                   ///< n_y n_c, column i is y_r(k+1+i)
  Vector setpoint;                    ///< n_y, what the references aim at
  Vector input_base_unclipped;        ///< n_u, -K x(k) + feedforward.col(0)
  Vector input_previous;              ///< n_u, u(k-1)
  Vector input_lower, input_upper;    ///< n_u, what the guard leaves of the limits for u(k); empty:
                                      ///< all of them
  Vector output_lower, output_upper;  ///< n_y, zones of a target layer; empty: there is none
};

/// Outcome of a constrained optimization.
enum class SolveStatus : std::uint8_t {
  kSolved = 1,
  kInfeasible = 2,
  kIterationLimit = 3,
  kNumericalError = 4,
  kInvalidProblem = 5,
  kNotRun = 6,        ///< the action was passed through (held, manual)
  kBoundWins = 7,     ///< solved, but move limit and bound conflict: the bound was kept
  kInconsistent = 8,  ///< u_base(k) does not follow from K, x and feedforward: clipped
};

/// What the optimizer did at sample k.
struct SolverReport {
  StepHeader header;
  Vector perturbation;  ///< n_u, c(k)
  SolveStatus status{SolveStatus::kNumericalError};
  std::uint32_t iterations{};
  double kkt_residual{};
  double seconds{};  ///< wall time of the solve; never used in a decision
  std::uint32_t active_rows{};
};

/// Where the plant is to rest, as decided at sample k; see section `targets`.
struct Targets {
  StepHeader header;
  Vector outputs;                     ///< n_y, what the law's references aim at
  Vector inputs;                      ///< n_u
  Vector output_lower, output_upper;  ///< n_y, zones as far as they can be kept; infinite if absent
  double cost{};                      ///< of the prices
  bool found{};                       ///< false: it is an older one, or where the plant is
};

/// What a controller follows at sample k.
struct Tracking {
  StepHeader header;
  Vector setpoint;   ///< n_y, clamped and rate-limited
  Vector reference;  ///< n_y, y_r(k)
};

/// What only a simulator knows of sample k.
struct PlantState {
  StepHeader header;
  Vector state;                    ///< n_states
  Vector outputs;                  ///< n_y, free of noise and sensor faults
  Vector disturbances;             ///< n_d, the true ones
  std::uint32_t actuator_clips{};  ///< how many inputs of u(k-1) the actuator had to clip
  bool input_missing{};            ///< no action in time for u(k-1): held or fallback
  std::string trouble;             ///< why the plant did not move with u(k-1), empty if it did
};

/// How a value sent by a person acts on a named signal.
enum class CommandMode : std::uint8_t { kOverride = 1, kOffset = 2, kRelease = 3 };

/// A person's wish for setpoints or disturbances. time_ns = 0: from the next unanswered sample.
struct Command {
  std::int64_t time_ns{};
  std::vector<std::string> name;
  std::vector<double> value;
  CommandMode mode{CommandMode::kOverride};
};

}  // namespace fpc
