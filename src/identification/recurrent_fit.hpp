// Fit of a recursion to free runs over several stretches of a record: Levenberg-Marquardt with
// exact derivatives through time.
#pragma once

#include <functional>
#include <vector>

#include "identification/recurrent_model.hpp"

namespace fpc {

/// Rows first..last - 1 of a record: one free run.
struct Stretch {
  Eigen::Index first{}, last{};
};

struct RecurrentFitParams {
  int iterations{60};
  double ridge{1.0};         ///< pulls consequents to `anchor`, in squared errors of unit `noise`
  double set_ridge{0.3};     ///< the same for centres and log widths, towards their start
  double one_step_weight{};  ///< companion only: of one-step errors, each in its own unit
  double free_unit{1.0};     ///< error that counts as 1 in free run
  double step_unit{1.0};     ///< and one step ahead
  double start_ridge{0.1};   ///< hidden state: pull of a stretch's start towards its guess
  double settle{1e-4};       ///< relative fall of the objective below which the fit has settled
  Vector centre_lower, centre_upper;  ///< bounds of the sets' centres, rule by rule; empty: none
  /// Moves unknowns (parameters, then starts) to the nearest that prior knowledge admits, in the
  /// metric of a Gauss-Newton matrix; false: there are none near. Empty: all are admitted.
  std::function<bool(const Matrix& metric, Vector& unknowns)> admit;
};

struct RecurrentFitResult {
  Vector parameters;
  Matrix starts;  ///< states x stretches, hidden state only
  double objective{};
  int iterations{};
  double work{};  ///< multiply-adds, see WorkMeter
  bool finite{false};
};

/// Minimises the errors of free runs over the stretches from `start`; never ends worse than it
/// began. Errors count as none where the sensor's limit is reached on both sides. `proceed` may be
/// empty, is asked once an iteration with the present parameters and ends the fit by false.
/// Source: ljung1999, sec. 10.2-10.3; williams1989 for the derivatives.
RecurrentFitResult fitRecurrent(const RecurrentShape& shape, const RecurrentData& data,
                                const std::vector<Stretch>& stretches, const Vector& anchor,
                                const Vector& start, const RecurrentFitParams& params,
                                const std::function<bool(const Vector&)>& proceed = {});

/// What starts a hidden state: a distribution of states and how exactly the output is measured.
struct StartPrior {
  Vector mean;
  Matrix covariance;
  double noise{};       ///< std of the measured output
  Vector lower, upper;  ///< a run's states are held inside; empty: far away only
};

/// Outputs of a free run over a stretch (NaN before its start): companion states start with the
/// measured past, hidden ones with the estimate from the first `window` samples.
Vector runRecurrent(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                    const Vector& parameters, const StartPrior& prior, int window = 5);

/// States along a free run from a given start (n x length).
Matrix statesOf(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                const Vector& parameters, const Vector& start);

}  // namespace fpc
