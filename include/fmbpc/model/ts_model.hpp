// Takagi-Sugeno models: rules with fuzzy antecedents and affine consequents, any number of outputs,
// inputs, disturbances, lags and delays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"
#include "fmbpc/model/domain.hpp"
#include "fmbpc/model/membership.hpp"
#include "fmbpc/model/multivariate_membership.hpp"

namespace fpc {

enum class SignalKind : std::uint8_t { kOutput = 1, kInput = 2, kDisturbance = 3, kUnmeasured = 4 };

/// A signal at time k - lag, seen from the prediction of k + 1. Lag 0 of an input is u(k).
struct Regressor {
  SignalKind kind{SignalKind::kOutput};
  int index{};  ///< into the model's signals of this kind
  int lag{};
  bool operator==(const Regressor& o) const {
    return kind == o.kind && index == o.index && lag == o.lag;
  }
};

/// If every antecedent holds, then y(k+1) = coefficients . regressors + offset.
struct Rule {
  std::vector<Membership> antecedents;  ///< one per antecedent variable; none if multivariate
  Vector coefficients;                  ///< one per regressor of the output
  double offset{};
  std::uint64_t data_count{};  ///< identification data behind it, 0 if unknown
  /// Instead of `antecedents`, one set on all antecedent variables; in all rules of an output or in
  /// none.
  std::optional<MultivariateMembership> multivariate{};
};

/// The submodel of one output.
struct OutputModel {
  std::vector<Regressor> antecedents;  ///< variables of the rule antecedents
  std::vector<Regressor> regressors;   ///< variables of the consequents
  std::vector<Rule> rules;
};

/// A model with names and units, as in its file. The order of names is the model's own, not
/// PlantInfo's.
struct TsModel {
  std::string name;
  std::string source;  ///< provenance in words
  double sample_time_s{};
  std::vector<SignalInfo> outputs, inputs,
      disturbances;                    ///< lower/upper: range of the data, or infinite
  std::vector<SignalInfo> unmeasured;  ///< disturbances that this loop estimates: matchToPlant()
  std::vector<OutputModel> submodels;  ///< one per output
  ModelDomain domain;                  ///< where the data were; may be empty

  /// @throws InputError naming the part: sizes, indices, lags, non-finite coefficients, no rules,
  /// repeated names, multivariate rules among others.
  void validate() const;
  int maxLag(SignalKind kind, int index) const;  ///< -1 if unused
  const std::vector<SignalInfo>& signals(SignalKind kind) const;
  std::string text(const Regressor& regressor) const;  ///< as in model files: "s(k)", "q_r(k-1)"
};

/// Firing weights of the rules of one output: >= 0, sum 1, for any finite antecedent values.
/// If no rule fires the nearest one gets weight 1 and `fired` is false.
struct FiringResult {
  Vector weights;
  bool fired{true};
};
void firingWeights(const OutputModel& model, VectorRef antecedent_values, FiringResult& result);

/// Things a user should know of a model before trusting it; see reportModel().
struct RuleRemark {
  std::string output;
  std::size_t rule{};  ///< from 1
  std::string
      text;  ///< "zero coefficients: rank-deficient fit", "pole 1.03: drifts in free run", ...
};
std::vector<RuleRemark> reportModel(const TsModel& model);

}  // namespace fpc
