// Sensors that stand still while the rest of the plant moves, and what a law does then: a
// controller around any law.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/affine_law.hpp"
#include "fmbpc/control/controller_around.hpp"
#include "fmbpc/control/standstill_params.hpp"

namespace fpc {

/// Smallest and largest value of each signal over the newest samples. No allocation in add().
class SignalWindow {
 public:
  SignalWindow() = default;
  SignalWindow(Eigen::Index signals, int samples) : values_(signals, samples) {}
  void clear() { known_ = next_ = 0; }
  void add(const Measurement& now);  ///< outputs, disturbances, applied inputs
  bool full() const { return known_ == values_.cols(); }
  double span(Eigen::Index signal) const;
  double mean(Eigen::Index signal) const;

 private:
  Matrix values_;  // a row per signal
  Eigen::Index known_{}, next_{};
};

/// A watched signal stands still from the sample at which it has changed by less than
/// `least_change` over the window while what drives the plant has moved: another measured
/// disturbance that does not stand still itself, for outputs also an applied input; until it has
/// moved by that much. Meanwhile
/// - a disturbance has its usual value for the law, which goes on;
/// - an output makes the fallback act (source fallback, no prediction) inside the limits; the law
/// is
///   reset, bumplessly, when the output is back.
/// remark says which signal. Otherwise the law's answers pass untouched.
class StandstillWatch final : public ControllerAround {
 public:
  /// @throws InputError naming the field.
  StandstillWatch(std::unique_ptr<Controller> inside, StandstillParams params, InputLimits limits,
                  PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;

 private:
  Eigen::Index rowOf(const WatchedSignal& signal) const;
  double valueOf(const Measurement& now, const WatchedSignal& signal) const;
  bool othersMove(const WatchedSignal& signal) const;
  void watch(const Measurement& now);
  void fallBack(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output);

  StandstillParams params_;
  InputLimits limits_;
  Eigen::Index n_y_;
  SignalWindow window_;
  AffineLaw plan_;
  Measurement seen_;
  std::vector<bool> still_;           // by watched signal
  std::vector<double> stood_at_;      // the value at which each stands
  std::vector<std::string> remarks_;  // by watched signal
  bool away_{false};                  // the fallback acted at the last sample
};

}  // namespace fpc
