// A plant that answers actions with measurements: equations, disturbances, actuator, sensors,
// injected faults.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/plant/plant.hpp"
#include "plant/actuator.hpp"
#include "plant/disturbance.hpp"
#include "plant/instruments.hpp"
#include "plant/integrator.hpp"
#include "plant/transport_delay.hpp"

namespace fpc {

inline constexpr double kLatestCommandH = 1e6;

/// A command of the loop file, at a time after the start, at most kLatestCommandH.
struct ScheduledCommand {
  double time_h{};
  Command command;
};

struct SimulationParams {
  std::string plant;
  PlantParameters parameters;
  PlantFactory factory;                ///< of the loop file; empty: makePlant() by name
  Vector initial_state;                ///< n_states
  std::vector<std::string> outputs;    ///< measured ones, in this order; empty: the plant's default
  std::vector<double> output_delay_s;  ///< transport delay of each measured output; empty: none
  std::vector<std::string> measured_disturbances;  ///< subset of the plant's, in PlantInfo order
  IntegratorParams integrator;
  ActuatorParams actuator;
  Vector disturbance_nominal;     ///< n_d
  DisturbanceRecord disturbance;  ///< empty: nominal for ever; an endless run keeps the last column
  std::vector<ScheduledCommand> disturbance_commands;
  Vector disturbance_noise_std;  ///< n_d, of white noise on each disturbance; empty: none
  Vector noise_std;  ///< n_y, standard deviation of white measurement noise; empty: none
  std::uint64_t noise_seed{1};
  InstrumentParams instruments;  ///< sensors of outputs and measured disturbances
  double sample_time_s{1.0};
  double start_time_s{1.0};
  std::uint32_t samples{};  ///< N; 0 is endless
};

/// States and algebraic quantities, in this order.
std::vector<Quantity> measurable(const PlantDescription& plant);
/// The plant of these params. @throws InputError as makePlant() by name.
std::unique_ptr<Plant> makePlant(const SimulationParams& params);

/// Owns the state of a simulated plant. Deterministic: same params, commands and actions give the
/// same bits.
class Simulation {
 public:
  /// @throws InputError naming the field.
  explicit Simulation(SimulationParams params);

  const PlantInfo& info() const { return info_; }
  const PlantDescription& description() const { return plant_->description(); }
  const SampleClock& clock() const { return clock_; }

  /// Back to sample 0 under a new run_id; releases all commands but the scheduled ones.
  const Measurement& reset(std::uint64_t run_id);
  const Measurement& measurement() const { return measurement_; }  ///< sample k, until advance()
  const PlantState& state() const { return state_; }
  const Actuator& actuator() const { return actuator_; }

  /// True if the action answers the present sample; anything else must be dropped (and counted) by
  /// the caller.
  bool answers(const StepHeader& header) const;
  /// Applies u(k) and moves to sample k+1; does nothing at the final sample.
  const Measurement& advance(VectorRef input);
  /// Moves on without an action (realtime only): hold, then fallback.
  const Measurement& advanceWithoutAction();

  /// Names that commands may use: the disturbances, "input/NAME" (what the valve really does),
  /// "output/NAME" (what the sensor shows).
  const std::vector<std::string>& commandNames() const { return commands_.names(); }
  /// A person's command; returns the step from which it acts (stamp 0: the next sample to be
  /// measured, and never before that). Inputs stay inside the actuator's bounds and offset
  /// disturbances inside the plant's ranges.
  /// @throws InputError, also for a disturbance overridden by a value outside its range; nothing is
  /// taken then.
  std::uint32_t command(const Command& command);
  /// Commands that took effect with the present sample.
  const std::vector<CommandEffect>& effects() const { return effects_; }
  /// Disturbances of the present sample (n_d) as they were without commands: nominal, or of the
  /// record.
  const Vector& scheduledDisturbances() const { return scheduled_; }

  /// What people ask in vain at the present sample, and a plant that was not moved to it.
  const std::vector<Event>& events() const { return events_; }
  /// Last sample since the reset at which the plant could not be moved, with the reason; empty if
  /// none. The state was held over it, and state().trouble says so at the sample after it.
  const std::string& trouble() const { return trouble_; }
  /// Replaces the transport delay of one output (from the tf tree), before the first advance().
  /// @throws InputError later, and for an unusable delay.
  void setOutputDelay(std::size_t output, double seconds);
  const std::vector<double>& outputDelays() const { return params_.output_delay_s; }  ///< n_y [s]

 private:
  void schedule();
  void updateDisturbances();
  void passLocalLoop();
  void measure();
  void gatherEvents();
  void startInstruments();
  double outputOf(std::size_t i) const;
  void lookAtPlant();
  const Measurement& integrate();
  void movePlant();

  SimulationParams params_;
  std::unique_ptr<Plant> plant_;
  SampleClock clock_;
  Actuator actuator_;
  Integrator integrator_;
  Instruments instruments_;
  std::unique_ptr<PlantStepper> stepper_;  // moves the plant if there is one
  CommandTable commands_;
  PlantInfo info_;
  Measurement measurement_;
  PlantState state_;
  std::vector<CommandEffect> effects_;
  std::vector<Event> events_;
  std::mt19937_64 noise_, disturbance_noise_;
  std::string trouble_, failure_;        // failure_: over the sample before
  Vector scheduled_;                     // disturbances without commands
  Vector disturbance_error_;             // of their noise, at this sample
  Vector state_before_;                  // one sample ago
  Vector true_outputs_, true_measured_;  // what the sensors look at
  Vector plant_input_;                   // the applied input as the plant's local loop passes it on
  std::vector<Eigen::Index> output_index_;  // of each output: among the states, then the algebraic
  Vector held_input_, algebraic_;           // u until now, and what the plant makes of it
  std::vector<Eigen::Index> measured_disturbance_;  // index into the plant's disturbances
  std::vector<TransportDelay> delays_;              // of each output
};

/// The same params with defaults filled in. @throws InputError naming the field that does not suit
/// the plant.
SimulationParams checked(SimulationParams params, const Plant& plant);
/// What the plant tells controllers: bounds of the inputs are the actuator's. Header of sample 0
/// with run_id 0.
PlantInfo makePlantInfo(const SimulationParams& params, const PlantDescription& description);

}  // namespace fpc
