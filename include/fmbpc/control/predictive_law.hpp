// What all laws with a fuzzy model share: references, start and hand-over without a bump, holding
// what was applied when nothing better is known, and the prediction for an optimizer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/layout.hpp"
#include "fmbpc/control/bumpless_transfer.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/plan_view.hpp"
#include "fmbpc/control/reference.hpp"

namespace fpc {

class YamlSection;
struct ControllerContext;

/// One sample as a law sees it.
struct LawSample {
  const Measurement& now;
  const SetpointSource& setpoint;
  const ReferenceTrajectory& reference;  ///< y_r(k)
  const Vector& disturbances;            ///< d(k) as the model takes it
  const Vector& past_disturbances;       ///< d(k-1)
};

/// What a law makes of a sample.
struct Proposal {
  EventCode trouble{EventCode::kNone};  ///< why the input is not to be used
  Notice notice{};                      ///< what is to be known of it
};

/// The part of a law whose size depends on model and tuning: where the process stands, and the
/// input that follows. Per sample rest() or advance(), then look(), then propose() (again after
/// adoptTuning()), then predict(). No allocation in them, nor in inherit() and adoptTuning().
class LawCore {
 public:
  LawCore();
  virtual ~LawCore() = default;
  virtual void rest(const LawSample& sample) = 0;  ///< the process has rested at this sample
  virtual void forget() {}                         ///< see Controller
  virtual void advance(const LawSample& sample) = 0;
  /// y(k) as it expects it after u(k-1) and d(k-1).
  virtual void foresee(VectorRef input, VectorRef past_disturbances,
                       Eigen::Ref<Vector> outputs) = 0;
  /// Goes on with the memory of an older core; false (rest() then) if that means nothing here.
  virtual bool inherit(const LawCore& older) = 0;
  /// The rules at this sample. False if none fired: then the nearest one is used.
  virtual bool look(const LawSample& sample) = 0;
  virtual Proposal propose(const LawSample& sample, Vector& input) = 0;
  virtual bool finite() const = 0;  ///< false: what it knows of the process is of no use
  /// All of it but header, setpoint and what is said of u(k).
  virtual void predict(PredictiveAction& prediction) const = 0;
  /// Number `which` of the signals of an output.
  virtual double signal(Eigen::Index output, std::size_t which) const = 0;
  /// Number i of the disturbances that it estimates.
  virtual double estimated(std::size_t /*i*/) const { return 0.0; }
  virtual const Vector& referencePole() const = 0;  ///< n_y, a_r
  /// See PlanView; none by default.
  virtual Eigen::Index plannedSteps() const { return 0; }
  virtual void planned(Eigen::Index /*i*/, Eigen::Ref<Vector> /*point*/) const {}
  virtual void setTrustThreshold(double /*threshold*/, Eigen::Index /*least*/) {}
  virtual void adoptTuning() {}  ///< a tuning that was prepared counts from now on
};

/// What every predictive law is told.
struct PredictiveLawParams {
  Vector reference_pole;      ///< n_y, a_r
  Vector reference_holdback;  ///< n_y, > 0: y_r stays so near to y; empty: wherever
  bool preview{false};        ///< references follow the setpoint schedule over the horizon
  double transfer_decay{kTransferDecay};  ///< of the bias of a bumpless start, [0, 1)
  int prediction_steps{1};                ///< n_c of the predictive_action
  /// @throws InputError naming the field ("controller.reference_pole").
  void validate(Eigen::Index n_y) const;
};

/// Reads those keys over their defaults. @throws InputError naming file, key and what was expected.
void readPredictiveLaw(YamlSection& section, const ControllerContext& loop,
                       PredictiveLawParams& params);

/// After an upset the reference goes on from within reference_holdback of the outputs: a law that
/// was made for errors of that size is not asked for more, and an event says so. What is
/// published is the reference that nothing holds back. A start in the middle of a run adds a bias
/// to u that makes it the applied input and dies out (BumplessTransfer). A new core or tuning takes
/// over in the next step: the old one still says what u(k) would have been, and the new one starts
/// with a bias that makes its u(k) the very same. If anything is not finite, or the core is in
/// trouble, the last applied input is held (clipped), ok is false, and there is no prediction.
/// signals(): those of the core for each output, NAME_unclipped of each input, and NAME_estimate of
/// each disturbance that it estimates.
class PredictiveLaw : public Controller, public PlanView {
 public:
  void reset(const Measurement& start) override;
  void forget() override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool foresee(const Measurement& now, Eigen::Ref<Vector> outputs) override;
  bool needsModel() const override { return true; }
  Eigen::Index plannedSteps() const override { return inRun() ? core_->plannedSteps() : 0; }
  void planned(Eigen::Index i, Eigen::Ref<Vector> point) const override {
    core_->planned(i, point);
  }
  void setTrustThreshold(double threshold, Eigen::Index least) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }

 protected:
  /// output_signals: "model" for the signal NAME_model of each output. @throws InputError of
  /// limits.
  PredictiveLaw(const PredictiveLawParams& params, const InputLimits& limits,
                const PlantInfo& plant, const std::vector<std::string>& output_signals,
                const std::vector<std::string>& estimated = {});
  /// d(k) is known; once a sample.
  virtual void note(const LawSample& /*sample*/) {}
  /// The core that counts next: one that waits, or the present one; may be null.
  LawCore* newest() { return successor_ ? successor_.get() : core_.get(); }
  void takeOver(std::unique_ptr<LawCore> core);
  /// newest() waits for adoptTuning(), the references for these poles.
  void tuningPrepared(const Vector& reference_pole);
  const PlantInfo& plant() const { return plant_; }
  const InputLimits& limits() const { return limits_; }

 private:
  void prepareReference(const Vector& pole);
  bool inRun() const { return core_ && running_ && !start_pending_; }
  void estimate(const LawSample& sample);
  Proposal propose(const LawSample& sample);
  void handOver(const LawSample& sample, bool& fired, Proposal& proposal);
  void adopt();
  void act(const LawSample& sample, ControllerOutput& output);
  void hold(const Measurement& now, const Notice& why, ControllerOutput& output);
  bool holdBack(const Measurement& now);
  void refreshSignals();
  void predict(const LawSample& sample, PredictiveAction& prediction) const;

  InputLimits limits_;
  PlantInfo plant_;
  bool preview_;
  Vector holdback_;             ///< n_y
  std::size_t output_signals_;  ///< of each output
  ReferenceTrajectory reference_;
  std::optional<ReferenceTrajectory> next_reference_;  ///< with the poles of what waits
  BumplessTransfer transfer_;
  Vector disturbances_, past_disturbances_;
  Vector proposal_;    ///< u(k), unclipped
  Vector last_input_;  ///< the last finite input, applied or sent
  std::unique_ptr<LawCore> core_;
  std::unique_ptr<LawCore> successor_;  ///< takes over in the next step
  std::unique_ptr<LawCore> retired_;    ///< freed when the next one comes, outside of a step
  std::vector<std::pair<std::string, double>> signals_;
  double trust_heeded_{0.0};  ///< see PlanView; 0: none is
  Eigen::Index trust_least_{};
  bool tuning_waits_{false};
  bool start_pending_{true};  ///< the state is to be taken from the next measurement
  bool running_{false};       ///< a step has been asked for since the reset
};

using LawLayout = LayoutOf<PredictiveLaw, PredictiveLawParams, LawCore, LawSample, Proposal>;
template <>
void requireSameLayout<LawLayout>();

inline LawCore::LawCore() { requireSameLayout<LawLayout>(); }

}  // namespace fpc
