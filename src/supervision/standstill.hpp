// Sensors that stand still while the rest of the plant moves, and what a law does then: a
// controller around any law.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "control/controller_around.hpp"
#include "supervision/signal_window.hpp"
#include "supervision/standstill_params.hpp"

namespace fpc {

/// A watched signal stands still from the sample at which it has changed by less than
/// `least_change` over the window while what drives the plant has moved: another measured
/// disturbance that does not stand still itself, for outputs also an applied input; until it has
/// moved by that much. A signal with noise also stands still once its spread over the longer window
/// is explained by that noise alone, while the means of a disturbance (a block of the window each,
/// in its older half) have moved by more than their own noise; until one value, or the
/// mean of half a window, is farther from the mean of that window than noise gets. A disturbance at
/// the largest value so far may be limited there, as a flow over a weir: it does not stand still.
/// Meanwhile
/// - a disturbance has its usual value for the law, which goes on;
/// - an output makes the fallback act (source fallback, no prediction) inside the limits, from its
///   start (a PI from its bias); the law is reset, bumplessly, when the output is back.
/// signal_frozen says which signal. Otherwise the law's answers pass untouched.
class StandstillWatch final : public ControllerAround {
 public:
  /// `fallback`: needs no model; none: params.fallback. @throws InputError naming the field.
  StandstillWatch(std::unique_ptr<Controller> inside, std::unique_ptr<Controller> fallback,
                  StandstillParams params, InputLimits limits, PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;

 private:
  Eigen::Index rowOf(const WatchedSignal& signal) const;
  double valueOf(const Measurement& now, const WatchedSignal& signal) const;
  template <class Moves>
  bool othersMove(const WatchedSignal& signal, bool inputs, Moves moves) const;
  bool isAtLimit(std::size_t signal, double value) const;
  bool showsTheSame(std::size_t signal) const;
  bool showsOnlyNoise(std::size_t signal) const;
  bool meanHasMoved(std::size_t signal) const;
  void judge(std::size_t signal, double value);
  void watch(const Measurement& now);
  void beginFallback();
  void fallBack(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output);

  StandstillParams params_;
  InputLimits limits_;
  Eigen::Index n_y_;
  SignalWindow window_;
  std::unique_ptr<Controller> fallback_;
  Measurement seen_;
  std::vector<bool> still_;              // by watched signal
  std::vector<double> stood_at_;         // the value at which each stands ...
  std::vector<double> allowed_;          // ... and how far from it is still there
  std::vector<double> least_, largest_;  // so far
  std::vector<bool> under_noise_;        // it was found by its noise
  std::vector<std::string> texts_;       // by watched signal
  bool away_{false};                     // the fallback acted at the last sample
};

}  // namespace fpc
