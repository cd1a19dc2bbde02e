// Predictive control by search: plans of inputs are simulated over the horizon with a model of any
// kind, the best one's first input is sent. The search is the derived controller's.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/mpc/plan_cost.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/reference.hpp"

namespace fpc {

class ShiftedModel;

/// What a search made of a sample.
struct PlanFound {
  bool usable{false};                 ///< the plan is finite and inside the limits
  double cost{};                      ///< J
  int effort{};                       ///< iterations or evaluations
  EventCode event{EventCode::kNone};  ///< also when usable
};

/// Each sample: the model moves on with u(k-1), the measured outputs take the place of the
/// predicted ones, and what lay between them is added to every predicted sample. With `observe` an
/// extended Kalman filter moves the whole state, those that are not measured too, and what is added
/// is its disturbance, or with input_std stated that of the inputs; Jacobians come from
/// differences, and the covariance of a start from how its rest changes with what was measured.
/// Measurements that are late (SampleModel::delaySteps()) correct the state of their own time, from
/// which the model runs forward on the inputs applied since, corrected in every sample. The search
/// starts from the plan of the sample before, moved on by one sample and put inside the limits; if
/// it fails that plan's input is sent, ok is false and the source `clipped`. Hard limits on inputs
/// and moves. signals(): NAME_correction of each output, NAME_disturbance of each input if it has
/// one, plan_cost, plan_effort. A horizon at whose end an input has hardly begun to act is
/// said where plans begin anew (horizon_too_short). While somebody else has the inputs the state
/// moves on (lookOn()); reset() at the next sample keeps it, and plans anew.
class HorizonMpc : public Controller {
 public:
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  void lookOn(const Measurement& now) override;
  bool foresee(const Measurement& now, Eigen::Ref<Vector> outputs) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }
  const Vector& plan() const { return plan_; }  ///< n_u M, of the last sample

 protected:
  /// @throws InputError naming the field.
  HorizonMpc(HorizonParams params, InputLimits limits, const PlantInfo& plant);
  /// Takes a model: the next step starts from rest at the measurement.
  void predictWith(std::unique_ptr<SampleModel> model);
  /// Improves `plan`, which is inside the limits, for cost(). Its size stays.
  virtual PlanFound search(const Measurement& now, Vector& plan) = 0;

  PlanCost& cost() { return *cost_; }
  const InputLimits& limits() const { return limits_; }
  const HorizonParams& params() const { return params_; }
  const Vector& range() const { return range_; }  ///< n_u, upper - lower, or 1 where that is 0

 private:
  bool goesOn(const StepHeader& header) const;
  bool estimate(const Measurement& now);
  void restPlan(const Measurement& now);
  bool isShortSighted(const Measurement& now);
  bool observe(const Measurement& now);
  bool linearise();
  bool takeColumn(Eigen::Ref<Vector> column, double h);
  void restAnew(const Measurement& now);
  void remember(const Measurement& now);
  bool runForward();
  void refreshSignals(const PlanFound& found);

  HorizonParams params_;
  InputLimits limits_;
  Eigen::Index n_y_, n_u_;
  Vector range_;
  std::unique_ptr<SampleModel> model_;
  ShiftedModel* shifted_{nullptr};  // model_, where disturbances are at the inputs
  std::unique_ptr<PlanCost> cost_;
  std::optional<DisturbanceObserver> observer_;
  Matrix A_, E_;         // of the model at the state of k-1
  Matrix root_;          // of the covariance of a start
  Vector moved_, next_;  // for the differences
  Vector measured_, input_;
  ReferenceTrajectory reference_;
  Matrix future_;         // n_y, P and the lead
  Matrix inputs_, past_;  // u and d of the samples since the measured outputs were true, and before
  Vector state_;          // when the measured outputs were true
  Vector present_, correction_, disturbances_, plan_, kept_;
  Vector trial_;      // moves, n_u
  StepHeader seen_;   // of the last sample
  bool fresh_{true};  // the state is to be taken from the next measurement
  bool anew_{true};   // the plan as well
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
