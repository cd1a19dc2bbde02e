// Limits of the closed-loop paradigm as a QP sees them: input limits are plain bounds, move limits
// fixed rows, output limits soft rows that share one slack per output.
#pragma once

#include <vector>

#include "control/clp/prediction.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct ClpParams;
struct ClpProblem;

/// Rows, in this order: moves u(i) - u(i-1) for i >= 1; per limited output its upper, then its
/// lower rows. The first move is folded into the bounds of u(0); where
/// they conflict the bound wins. Allocates at construction only.
class ClpLimits {
 public:
  /// `params` with all limits filled in.
  ClpLimits(const ClpParams& params, const InputLimits& limits, const ClpSizes& sizes);
  Eigen::Index slacks() const { return n_slacks_; }
  Eigen::Index rows() const { return n_rows_; }
  bool incremental() const { return incremental_; }
  /// Writes what never changes: move rows, slack columns, penalties, input_scale.
  void prepare(ClpProblem& problem) const;

  /// Bounds of this sample: absolute, or around u_ss (incremental); those of u(k) inside what the
  /// guard leaves.
  void set(const PredictiveAction& now, VectorRef u_ss);
  /// A move limit gives way to a bound at this sample.
  bool boundWins() const { return bound_wins_; }
  /// Whether a sequence is allowed, sample by sample (exact comparisons; NaN is not allowed).
  bool admitsFirst(VectorRef input) const;
  bool admitsNext(VectorRef input, VectorRef previous) const;
  bool admitsOutput(VectorRef output) const;
  /// Writes bounds and soft rows of this sample; the first move_rows of A are left as prepared.
  void fill(const PredictiveAction& now, const ClpPrediction& prediction, ClpProblem& problem);

 private:
  Eigen::Index fillOutput(const PredictiveAction& now, const ClpPrediction& prediction,
                          Eigen::Index slack, Eigen::Index row, ClpProblem& problem) const;
  void fillSlackColumns(ClpProblem& problem) const;

  ClpSizes sizes_;
  InputLimits limits_;
  Vector output_lower_, output_upper_;  ///< of this sample
  Vector stated_lower_, stated_upper_;  ///< of the params
  Vector output_weight_, increment_lower_, increment_upper_;
  bool incremental_;
  double penalty_;
  std::vector<Eigen::Index> limited_outputs_, limited_moves_;
  Eigen::Index n_slacks_{}, n_rows_{};
  Vector lower_, upper_, first_lower_, first_upper_;
  bool bound_wins_{false};
};

}  // namespace fpc
