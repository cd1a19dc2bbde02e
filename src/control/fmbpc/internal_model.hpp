// Where the process stands by its model, and how far that is from the measurements: one class per
// realisation. Private to the room.
#pragma once

#include <memory>

#include "control/fmbpc/law.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// The model that a law predicts with. Per sample: rest() or advance(), then blend(), then
/// compare(). No allocation in them, nor in inherit().
class InternalModel {
 public:
  virtual ~InternalModel() = default;
  virtual void rest(const Measurement& now, VectorRef disturbances);  ///< starts from here
  virtual void forget() {}                                            ///< see Controller
  /// From k-1, with its u and d, to k.
  virtual void advance(const Measurement& now, VectorRef disturbances) = 0;
  /// What advance() will expect to be measured; of the model as it was blended last.
  virtual void foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) = 0;
  virtual bool blend(VectorRef disturbances);  ///< false if no rule fired: the nearest one is used
  virtual void compare(const Measurement& now) = 0;
  /// Takes over the memory of an older model of the same realisation: the measured past, and its
  /// own state if only consequents differ. False if there is nothing to take over: rest() then.
  virtual bool inherit(const InternalModel& older) = 0;
  /// What is added to the model's output (or, per sample, to its state) to be offset-free.
  virtual double correctionOf(Eigen::Index output) const { return offset_output_[output]; }
  virtual double estimated(std::size_t /*i*/) const { return 0.0; }  ///< see LawCore
  /// The model of the undelayed process, as blended last.
  virtual const AffineModel& affine() const { return local_.affine(); }

  /// The rules at x(k) and an input that is known.
  void blendAt(VectorRef input, VectorRef disturbances);
  /// The same after compare(), which holds for the new rules as well.
  void replan(VectorRef input, VectorRef disturbances);

  const LocalModel& local() const { return local_; }             ///< the rules, without the delay
  const Vector& state() const { return state_; }                 ///< xi(k)
  const Vector& offsetState() const { return offset_state_; }    ///< g, and what compare() added
  const Vector& offsetOutput() const { return offset_output_; }  ///< y - y_m
  const Vector& undelayed() const { return undelayed_; }         ///< y_m0, without the delay
  const Vector& outputs() const { return outputs_; }             ///< y_m
  const Vector& correction() const;                              ///< offsetState() - g

 protected:
  /// What another model's memory is worth here.
  enum class Kinship { kNone, kSameLags, kSameRules };

  InternalModel(const TsModel& model, const FmbpcParams& params);
  void resize(Eigen::Index n_x);  ///< of the state, if it is not that of local()
  Kinship kinshipTo(const InternalModel& older) const;
  const Vector& antecedents() const { return at_measured_ ? measured_ : state_; }
  void predict(VectorRef input);  ///< next_ from state_
  void readUndelayed(const Vector& state);

  bool at_measured_;  ///< antecedents are measured outputs
  LocalModel local_;
  Vector measured_;  ///< local_'s rows filled with measurements
  Vector state_, next_;
  Vector offset_state_, offset_output_, undelayed_, outputs_;

 private:
  mutable Vector correction_;
};

/// `model` is matched to the plant. @throws InputError naming delay_steps or realisation if they do
/// not suit the model.
std::unique_ptr<InternalModel> makeInternalModel(const TsModel& model, const FmbpcParams& params);

}  // namespace fpc
