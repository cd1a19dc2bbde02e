// Sensors that stand still while the rest of the plant moves, and what a law does then: a
// controller around any law.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/affine_law.hpp"
#include "fmbpc/control/controller.hpp"

namespace fpc {

/// A measured signal that must not stand still.
struct WatchedSignal {
  std::string name;
  bool is_output{true};
  Eigen::Index place{};   ///< among outputs or measured disturbances
  double least_change{};  ///< largest minus smallest value over the window is usually more
};

/// Section `standstill` of a loop file.
struct StandstillParams {
  std::vector<WatchedSignal> signals;  ///< empty: nothing is watched
  int window_samples{24};
  double others_change{0.1};  ///< what drives the plant must have moved by this part of its mean
  Vector usual;               ///< n_d, the law's value of a disturbance that stands still
  Vector fallback;            ///< n_u, the input while an output stands still ...
  std::vector<AffineTerm> fallback_plan;  ///< ... and what the other signals add to it
  /// @throws InputError naming standstill.KEY.
  void validate(Eigen::Index n_y, Eigen::Index n_u, Eigen::Index n_d) const;
};

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
class StandstillWatch final : public Controller {
 public:
  /// @throws InputError naming the field.
  StandstillWatch(std::unique_ptr<Controller> inside, StandstillParams params, InputLimits limits,
                  PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  void lookOn(const Measurement& now) override { inside_->lookOn(now); }
  bool needsModel() const override { return inside_->needsModel(); }
  bool followsSetpoint() const override { return inside_->followsSetpoint(); }
  void setModel(const TsModel& model) override { inside_->setModel(model); }
  bool mayBeSent(VectorRef input) const override { return inside_->mayBeSent(input); }
  void makeSendable(Eigen::Ref<Vector> input) const override { inside_->makeSendable(input); }
  bool adapt(bool on) override { return inside_->adapt(on); }
  Settings settings() const override { return inside_->settings(); }
  bool retune(const Settings& settings) override { return inside_->retune(settings); }
  const std::vector<std::pair<std::string, double>>& signals() const override {
    return inside_->signals();
  }

 private:
  Eigen::Index rowOf(const WatchedSignal& signal) const;
  double valueOf(const Measurement& now, const WatchedSignal& signal) const;
  bool othersMove(const WatchedSignal& signal) const;
  void watch(const Measurement& now);
  void fallBack(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output);

  std::unique_ptr<Controller> inside_;
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
