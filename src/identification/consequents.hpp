// Coefficients of rules whose antecedents are known: local, global or recursive least squares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/data_set.hpp"
#include "identification/structure.hpp"

namespace fpc {

enum class RuleStatus { kFitted, kBorrowed, kDropped };

/// What the data say about one rule.
struct RuleFit {
  double evidence{};        ///< sum of the rule's firing weights over the data [samples]
  std::uint64_t samples{};  ///< samples in which it fires most
  double condition{};       ///< of its columns, weighted and scaled; global: of the whole system
  RuleStatus status{RuleStatus::kFitted};
  int lender{-1};      ///< borrowed: index of the rule that stands in; -1: the linear model
  std::string remark;  ///< why it was not fitted, else empty
};

/// The linear ARX model of the same regressors: one rule that always holds. Unexcited directions
/// get zeros.
OutputModel fitLinear(const Regression& data, const std::vector<Regressor>& regressors,
                      RuleFit& fit);

/// Fills coefficients, offset and data_count of all rules of `model`.
/// All methods work on columns scaled to mean 0 and deviation 1 and fit what the linear model
/// leaves over, so that the ridge draws coefficients towards the linear model, not towards zero:
///   local      sum_k w_i(k) (y - theta_i' x)^2 + ridge |theta_i - theta_lin|^2 for each rule by
///   itself: each rule is
///              the linearisation of its region, which keeps free runs and laws well-behaved;
///   global     sum_k (y - sum_i w_i theta_i' x)^2 + ridge sum_i |...|^2: best one-step
///   predictions; recursive  local, sample by sample with forgetting; ridge > 0 weighs the start.
/// Weights of `local` are the firing weights raised to weight_power (karer2007, eqs. 14-20,
/// with power 2, ridge 0 and a threshold). Scarce rules (see ConsequentParams) take the linear
/// model (borrow) or the fitted rule nearest to them in the same operating mode, that is with the
/// same crisp sets (neighbour), or are taken out of `model` (drop). `fits` has one entry per rule
/// as given. Weighted sums by QR of row blocks: no normal equations, fixed memory.
/// @throws InputError if all rules would be dropped, if a rule is scarce under `error`, or naming
/// ridge.
std::vector<RuleFit> fitConsequents(const Regression& data, const OutputModel& linear,
                                    const ConsequentParams& params, OutputModel& model);

}  // namespace fpc
