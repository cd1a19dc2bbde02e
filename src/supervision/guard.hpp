// What a predictive law does where its model has no data, and when it has locked itself up: a
// controller around the law.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "control/controller_around.hpp"
#include "supervision/growing_swings.hpp"
#include "supervision/guard_params.hpp"
#include "supervision/horizon_trust.hpp"

namespace fpc {

/// What the guard sees at one sample.
struct GuardView {
  double trust{1.0};    ///< least of now and of what the law wants
  bool outside{false};  ///< trust below GuardParams::trust_low
  double ahead{1.0};    ///< least trust over the horizon of what the law expects
  double near{1.0};     ///< of outputs and disturbances, GuardParams::look_ahead samples of a plan
  bool locked{false};   ///< some input is locked up
  bool acting{false};   ///< the input is not the law's
};

/// The largest error that counts.
struct WorstError {
  double size{};  ///< in units of its tolerance
  int whose{};    ///< its output, counted from 1, negative where it lies above its setpoint
};

/// Whether one input is locked up, found by trying. An input at a bound for `lock_samples` while
/// the error stays beyond its tolerance and does not shrink (last quarter of that time against the
/// first) is suspected. Its bound is then drawn in by lock_step of the range, and a window of
/// lock_samples later the error is compared with what it would have become at its old rate.
/// Smaller: less of what the law asks for helps, so the gain's sign is against the law: locked; the
/// bound is drawn in by another step. Not smaller: that step is taken back, and nothing is tried
/// for lock_release samples. A bound that helped opens over lock_release samples once the error
/// shrinks or the law leaves it, and as fast as it was drawn in (lock_step in lock_samples) while
/// the output for which that was done lies beyond its tolerance on the other side of its setpoint:
/// there it is the bound that is in the way.
class LockUpWatch {
 public:
  LockUpWatch(const GuardParams& params, double lower, double upper);
  void reset();
  /// One sample: the applied input, and the largest error in units of its tolerance. Returns
  /// whether the input is locked.
  /// @param whose the output of that error, counted from 1, negative where it lies above its
  /// setpoint; 0: not known.
  bool observe(double applied, double error, int whose = 0);
  double lower() const { return lower_ + (side_ < 0 ? drawn_ : 0.0); }
  double upper() const { return upper_ - (side_ > 0 ? drawn_ : 0.0); }
  bool drawnIn() const { return drawn_ > 0.0; }

 private:
  int sideOf(double applied) const;
  bool isInTheWay(double error, int whose) const;
  void open(double step);
  void suspect();
  void judge();
  double mean(Eigen::Index from) const;  ///< of a quarter of the window

  double lower_, upper_, range_, step_;
  int release_, wait_{0};
  int side_{0};            ///< of the bound that is watched or drawn in
  int whose_{0}, for_{0};  ///< error of now, and that for which the bound was drawn in
  double drawn_{0.0}, expected_{0.0};
  bool trying_{false}, locked_{false};
  Vector past_;  ///< lock_samples errors at the bound, oldest first
  Eigen::Index known_{};
};

/// The law `inside`, and five rules:
/// - trust at the measured outputs, disturbances and the input in force, and at the input that the
///   law wants: the smaller is said; what is done depends on outputs and disturbances only
///   (processTrustOf), as the bounds say which inputs are allowed, and where the law shows its plan
///   (PlanView) on the least of it over `look_ahead` samples: between trust_high and trust_low
///   moves shrink from half the range to `least_move`; below trust_low at present the fallback, if
///   there is one, acts (bumplessly) until trust has been above trust_high for `return_samples`;
/// - errors of a plan beyond the samples at which the model is trusted do not count, but the first
///   `horizon_least` after the longest dead time of an input do;
/// - an input that is locked up at its bound (see LockUpWatch) has that bound drawn in, if the
///   model knows the input: others stand where the plant has them;
/// - where the law swings an input further each time (see GrowingSwings) it does not hold this
///   plant: the fallback acts until the law begins anew (reset());
/// - so the guard narrows the limits of u(k): the law's input is put inside them (source `guarded`,
///   and an event says why), and the prediction hands them to an optimizer; where the fallback acts
///   the source is `fallback` and there is no prediction.
/// Inside its model's data the law's answers pass untouched, bit for bit. signals(): the law's,
/// then model_trust, model_trust_ahead (the least over the horizon), model_trust_steps (samples
/// ahead before it falls below trust_low; see HorizonTrust), locked.
class GuardedController final : public ControllerAround {
 public:
  /// @param fallback acts where the law may not; null: there moves shrink with trust.
  /// @throws InputError naming the field.
  GuardedController(std::unique_ptr<Controller> inside, std::unique_ptr<Controller> fallback,
                    GuardParams params, InputLimits limits, PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  void forget() override;
  void lookOn(const Measurement& now) override;
  bool expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) override;
  void setModel(const TsModel& model) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }
  const GuardView& view() const { return view_; }

 private:
  double trustAt(const Measurement& now, VectorRef input);
  void comeBack(const Measurement& now, double trust);
  void watchLocks(const Measurement& now, const SetpointSource& setpoint);
  WorstError worstError(const Measurement& now, const SetpointSource& setpoint) const;
  double trustForMoves(const Measurement& now);
  void shrink(double trust);
  bool swingsGrow(const Measurement& now);
  void fallBack(const Measurement& now, bool outside);
  void narrow(const Vector& before);
  void askFallback(const Measurement& now, const SetpointSource& setpoint,
                   ControllerOutput& output);
  void act(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output);
  void lookAhead(const Measurement& now, const ControllerOutput& output);
  void refreshSignals();

  PlanView* plan_;  // of inside_, or null
  GuardParams params_;
  InputLimits limits_, shrunk_;
  Vector lower_, upper_;  // of u(k)
  PlantInfo plant_;
  std::unique_ptr<Controller> fallback_;  // or null
  ControllerOutput fallback_output_;
  std::vector<LockUpWatch> locks_;      // one per input
  std::vector<GrowingSwings> growing_;  // one per input
  std::vector<bool> moved_;             // by input: the model knows it, so the law may move it
  TsModel model_;
  bool known_{false};  // the model says where its data were
  bool fallen_back_{false};
  bool unstable_{false};  // it is so for good
  bool begins_{false};    // the fallback, at this sample
  Measurement from_;      // from there: what swings, from its middle
  int above_{};           // samples in a row above trust_high
  Vector point_, proposed_;
  HorizonTrust ahead_;
  GuardView view_;
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
