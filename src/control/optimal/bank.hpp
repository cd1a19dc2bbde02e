// The rules of the fuzzy optimal law: their models, laws and disturbance estimates, and the blend
// of all at one sample. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include "fmbpc/control/model_observer.hpp"
#include "fmbpc/control/optimal/law.hpp"
#include "fmbpc/control/reference.hpp"
#include "fmbpc/fuzzy/local_model.hpp"
#include "fmbpc/fuzzy/shared_partition.hpp"

namespace fpc {

/// One rule of all outputs.
struct FuzzyOptimalRule {
  LocalModel model;
  QuadraticLaw law;    ///< K with u(k-1) in the state
  Matrix correction;   ///< n_u n_y: effect of d_g on the input
  Vector disturbance;  ///< d_g
  Vector constant;     ///< n_u: what does not depend on state and references
};

/// Per sample: rest() or advance(), then estimate(), then blend(), then forward(). No allocation in
/// them.
struct FuzzyOptimalLaw::Bank {
  /// `model` is matched to the plant. @throws InputError, see setModel() and retune().
  Bank(const TsModel& model, const FuzzyOptimalParams& params);

  void rest(const Measurement& now, VectorRef disturbances);
  void advance(const Measurement& now, VectorRef disturbances);  ///< d(k-1) as the model took it
  void look(const Measurement& now, VectorRef disturbances);
  /// d_g from the one-step errors; disturbances: those of k-1.
  void estimate(const Measurement& now, VectorRef disturbances);
  /// Models and laws at x(k), d(k). False if no rule fired; then the nearest one is used.
  bool blend(VectorRef disturbances, const Vector& input_target);
  /// u(k + i) = -K x(k + i) + forward(i).
  void forward(Eigen::Index i, Eigen::Ref<Vector> input) const;
  /// Takes over the memory of another bank; false (nothing taken) if its lags differ. No
  /// allocation.
  bool inherit(const Bank& other);

  FuzzyOptimalTuning tuning;
  bool inside, estimated;
  double gain;
  LocalModel local;       ///< all rules: firing weights, blended matrices
  std::size_t partition;  ///< output whose firing weights count
  std::vector<FuzzyOptimalRule> rules;
  std::optional<ModelObserver> observer;  ///< without: the measurements are believed
  bool short_sighted{false};              ///< some rule's horizon is too short for some input
  bool begun{false};                      ///< the d_g have been estimated since rest()
  Vector state, before;                   ///< x(k), x(k-1): measured, or as observed
  Vector predicted;                       ///< of one rule
  Vector seen;          ///< y(k): measured, or what the blended model and d expect
  Vector error;         ///< y - y_hat(k|k-1), blended
  Matrix future;        ///< col(i) = y_r(k+1+i)
  Matrix K, reference;  ///< blended
  Vector constant, offset_state, offset_output;
};

}  // namespace fpc
