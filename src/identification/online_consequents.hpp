// A model that keeps learning while the process runs: the consequents of its rules by recursive
// least squares, the antecedents fixed.
#pragma once

#include <vector>

#include "fmbpc/model/ts_model.hpp"
#include "optim/rls.hpp"

namespace fpc {

/// Updates every rule with the samples in which it fires, weighed by its firing weight; a rule that
/// does not fire keeps what it knows. Columns are scaled by the model's ranges (by 1 where they are
/// unknown). Source: angelov2004, eqs. 24-25 (weighted recursive least squares of
/// local models).
class OnlineConsequents {
 public:
  /// @throws InputError from TsModel::validate() or RlsParams::validate().
  OnlineConsequents(TsModel model, const RlsParams& params);

  /// Takes measurement k of consecutive ones: y(k), d(k) and u(k-1), in the model's order of
  /// signals.
  /// @return true if at least one submodel learned (its past is complete and all values are
  /// finite). No allocation. @throws InputError naming a wrong size.
  bool take(VectorRef outputs, VectorRef input_applied, VectorRef disturbances);
  /// Forgets the past values, not what was learned: after a gap, a reset of the plant, a new run.
  void forgetPast();
  /// The model as learned so far.
  const TsModel& model() const { return model_; }
  std::uint64_t samples() const { return samples_; }  ///< from which it has learned

 private:
  double value(const Regressor& r) const;
  bool learn(std::size_t output, double y);
  void write(std::size_t output, std::size_t rule);

  TsModel model_;
  std::vector<std::vector<RecursiveLeastSquares>> rules_;  // per output, per rule
  std::vector<Vector> shift_, scale_, x_, z_;  // per output, of its regressors and antecedents
  std::vector<FiringResult> firing_;
  Matrix past_;  // signals x longest lag; column 0: k - 1
  std::uint64_t samples_{};
};

}  // namespace fpc
