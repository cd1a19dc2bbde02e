// How u(k) follows from the internal model: one class per law. Private to the room.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/fmbpc/coincidence.hpp"
#include "control/fmbpc/disturbance_forecast.hpp"
#include "control/fmbpc/input_limited_ilqr.hpp"
#include "control/fmbpc/internal_model.hpp"
#include "fmbpc/control/predictive_law.hpp"

namespace fpc {

/// Per sample: follow(), propose(), predict(). No allocation in them, nor in retune().
class InputLaw {
 public:
  virtual ~InputLaw() = default;
  virtual void rest() {}  ///< the process has rested: no plan goes on
  /// Before the model goes on from k-1: what is known by now of the input that it got.
  virtual void follow(InternalModel& /*model*/, VectorRef /*input*/,
                      VectorRef /*past_disturbances*/) {}
  /// After the model's compare(). future.col(i) = y_r(k+1+i).
  virtual Proposal propose(InternalModel& model, const LawSample& sample, const Matrix& future,
                           Vector& input) = 0;
  /// K and feedforward (n_u n_c, sized) of the prediction.
  virtual void predict(const InternalModel& model, const Matrix& future,
                       PredictiveAction& prediction) const = 0;
  virtual void retune(const FmbpcParams& params) = 0;
  /// See PlanView; none by default.
  virtual Eigen::Index plannedSteps() const { return 0; }
  virtual void planned(const InternalModel& /*model*/, Eigen::Index /*i*/,
                       Eigen::Ref<Vector> /*point*/) const {}
  virtual void setTrustThreshold(double /*threshold*/, Eigen::Index /*least*/) {}
};

/// The outputs meet their references at one sample ahead: see CoincidenceGains. u = F e + V u(k-1).
class CoincidenceLaw : public InputLaw {
 public:
  CoincidenceLaw(const InternalModel& model, const FmbpcParams& params, Eigen::Index n_u);
  Proposal propose(InternalModel& model, const LawSample& sample, const Matrix& future,
                   Vector& input) override;
  void predict(const InternalModel& model, const Matrix& future,
               PredictiveAction& prediction) const override;
  void retune(const FmbpcParams& params) override;

 protected:
  virtual bool computeGains(const AffineModel& model) = 0;
  virtual Notice notice() const { return {}; }

  CoincidenceGains gains_;
  int coincidence_steps_;

 private:
  /// What y(k+H) lacks of the reference in this column without input and state.
  const Vector& shortfall(const InternalModel& model, const Matrix& future,
                          Eigen::Index column) const;

  Eigen::Index aim_;  ///< column of the references that u(k) aims at
  mutable Vector shortfall_;
  Vector settled_;  ///< what the offset of the state adds to y(k+H)
};

class PublishedLaw final : public CoincidenceLaw {
 public:
  using CoincidenceLaw::CoincidenceLaw;

 private:
  bool computeGains(const AffineModel& model) override;
};

class GeneralLaw final : public CoincidenceLaw {
 public:
  GeneralLaw(const InternalModel& model, const FmbpcParams& params, Eigen::Index n_u);
  void predict(const InternalModel& model, const Matrix& future,
               PredictiveAction& prediction) const override;
  void retune(const FmbpcParams& params) override;

 private:
  bool computeGains(const AffineModel& model) override;
  Notice notice() const override;

  Vector weight_output_, weight_move_;
  std::vector<std::string> idle_words_;  ///< by input; empty: no rule knows it
};

/// The first input of the best path over the horizon; the local model is then that of its first
/// sample, and the rest of the path is handed over as feedforward.
class IteratedLaw final : public InputLaw {
 public:
  /// forecast: what is expected of the disturbances; outlives the law.
  IteratedLaw(const InternalModel& model, const FmbpcParams& params, const InputLimits& limits,
              DisturbanceForecast& forecast);
  void rest() override { solver_.forget(); }
  void follow(InternalModel& model, VectorRef input, VectorRef past_disturbances) override;
  Proposal propose(InternalModel& model, const LawSample& sample, const Matrix& future,
                   Vector& input) override;
  void predict(const InternalModel& model, const Matrix& future,
               PredictiveAction& prediction) const override;
  void retune(const FmbpcParams& params) override;
  Eigen::Index plannedSteps() const override { return solver_.inputs().cols(); }
  void planned(const InternalModel& model, Eigen::Index i, Eigen::Ref<Vector> point) const override;
  void setTrustThreshold(double threshold, Eigen::Index least) override {
    trust_heeded_ = threshold;
    trust_least_ = least;
  }

 private:
  Eigen::Index trustedSteps(const InternalModel& model, const Matrix& expected);

  InputLimitedIlqr solver_;
  DisturbanceForecast& forecast_;
  Eigen::Index lead_, dead_time_;
  Matrix aimed_;  ///< n_y N, the references of x(k+1)...x(k+N)
  double trust_heeded_{0.0};
  Eigen::Index trust_least_{};
  Vector point_;
};

std::unique_ptr<InputLaw> makeInputLaw(const InternalModel& model, const FmbpcParams& params,
                                       const InputLimits& limits, DisturbanceForecast& forecast);

}  // namespace fpc
