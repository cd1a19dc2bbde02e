// What the law believes of the process: its model, the model's state, and how far it is from the
// measurements. Private to the room.
#pragma once

#include <memory>
#include <optional>

#include "control/fmbpc/smith_predictor.hpp"
#include "fmbpc/control/fmbpc/coincidence.hpp"
#include "fmbpc/control/fmbpc/law.hpp"
#include "fmbpc/control/fmbpc/path_planner.hpp"
#include "fmbpc/control/model_observer.hpp"
#include "fmbpc/fuzzy/canonical_form.hpp"
#include "fmbpc/fuzzy/local_model.hpp"

namespace fpc {

/// Everything whose size depends on the model. Per sample: rest() or advance(), then blend(), then
/// compare(). No allocation in them.
struct FmbpcLaw::Belief {
  /// `model` is matched to the plant. @throws InputError naming delay_steps or realisation if they
  /// do not suit the model.
  Belief(const TsModel& model, const FmbpcParams& params, Eigen::Index n_y, Eigen::Index n_u);

  void rest(const Measurement& now, VectorRef disturbances);     ///< starts from here
  void advance(const Measurement& now, VectorRef disturbances);  ///< d(k-1) as the model took it
  /// Returns false if no rule fired; then the nearest one is used.
  bool blend(VectorRef disturbances);
  void compare(const Measurement& now);
  /// Takes over the memory of the belief in an older model: the measured past, and the own state if
  /// only consequents differ. False if there is nothing to take over (other lags, another state
  /// space): rest() then. No allocation.
  bool inherit(const Belief& other);
  /// The model of the undelayed process, as blended last.
  const AffineModel& affine() const { return canonical ? canonical->affine() : local.affine(); }

  /// What is added to the model's output (or, per sample, to its state) to be offset-free.
  double correctionOf(Eigen::Index output) const;

  bool realigned, antecedent_measured;
  double offset_gain;
  LocalModel local;                        ///< the rules, without the delay
  std::optional<CanonicalForm> canonical;  ///< literal: the state space instead of local's
  CoincidenceGains gains;
  Vector state;                     ///< xi(k): own (parallel, literal) or measured (realigned)
  Vector measured;                  ///< local's rows filled with measurements
  Vector next;                      ///< xi(k) as predicted at k-1
  Vector offset_state;              ///< g
  Vector offset_output;             ///< y - y_m
  Vector error_filtered;            ///< w_hat
  Vector undelayed;                 ///< y_m0, output of the model without delay
  Vector outputs;                   ///< y_m
  Vector lacking;                   ///< e, without C A^H xi
  Vector correction;                ///< w_hat in the rows of the outputs
  std::optional<DelayedTwin> twin;  ///< with delay_steps > 0, unless observed
  std::optional<ModelObserver> observer;
  std::optional<PathPlanner> planner;  ///< of the iterated law
};

}  // namespace fpc
