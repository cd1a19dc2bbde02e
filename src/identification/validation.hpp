// Honest validation: one step ahead and in free run, always beside a linear model, residual tests,
// rule by rule.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "identification/data_set.hpp"
#include "identification/prediction.hpp"

namespace fpc {

/// Correlation of one-step residuals. White residuals stay inside +-bound for the stated share of
/// the lags.
struct ResidualCorrelation {
  double bound{};                    ///< half width of the confidence interval
  Vector autocorrelation;            ///< lags 1..n
  std::vector<std::string> signals;  ///< inputs and disturbances
  Matrix cross;  ///< signals x (n + 1): residual(k) with signal(k - lag - 1), lags 0..n; the newest
                 ///< cause first
  double outside{};  ///< share of all these values beyond the bound
};

struct OutputValidation {
  std::string output;
  FitFigures one_step, free_run;
  FitFigures linear_one_step, linear_free_run;
  ResidualCorrelation residual;
};

/// Validates model and linear model on the same rows. @throws InputError if their signals are not
/// those of the data.
std::vector<OutputValidation> validateModel(const TsModel& model, const TsModel& linear,
                                            const DataSet& data,
                                            const ValidationParams& params = {});

/// Correlation of a signal with itself, lags 1..n.
Vector autocorrelation(const Eigen::Ref<const Vector>& values, const ValidationParams& params);

/// Source: boxjenkins1970, sec. 8.2; bounds z / sqrt(N) of white residuals.
ResidualCorrelation residualCorrelation(const DataSet& data,
                                        const Eigen::Ref<const Vector>& residual,
                                        const ValidationParams& params);

/// Dynamics of one rule taken by itself, other outputs held.
struct RuleDynamics {
  std::string output;
  std::size_t rule{};  ///< from 1
  std::uint64_t data_count{};
  std::vector<std::complex<double>> poles;  ///< in the rule's own output
  std::vector<std::string> signals;         ///< other outputs, inputs, disturbances it depends on
  std::vector<double> gains;                ///< steady-state gain of each; infinite if a pole is 1
};
std::vector<RuleDynamics> ruleDynamics(const TsModel& model);

}  // namespace fpc
