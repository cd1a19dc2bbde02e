// What a user should know of a Takagi-Sugeno model before trusting it: rank-deficient fits and
// rules that run away.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fmbpc/fuzzy/ts_model.hpp"

namespace fpc {
namespace {

constexpr double kUnitCircle = 1.0 - 1e-9;

std::string fixedText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

/// Largest modulus of the poles of a rule in its own output: z^n = a_0 z^(n-1) + ... + a_(n-1).
double largestPole(const OutputModel& model, const Rule& rule, int output) {
  int n_lags = 0;
  for (const auto& r : model.regressors)
    if (r.kind == SignalKind::kOutput && r.index == output) n_lags = std::max(n_lags, r.lag + 1);
  if (n_lags == 0) return 0.0;
  Matrix companion = Matrix::Zero(n_lags, n_lags);
  companion.diagonal(-1).setOnes();
  for (std::size_t i = 0; i < model.regressors.size(); ++i) {
    const auto& r = model.regressors[i];
    if (r.kind == SignalKind::kOutput && r.index == output)
      companion(0, r.lag) = rule.coefficients[static_cast<Eigen::Index>(i)];
  }
  const Eigen::EigenSolver<Matrix> solver(companion, false);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

std::string zeroCoefficients(const TsModel& model, const OutputModel& submodel, const Rule& rule) {
  std::string names;
  for (std::size_t i = 0; i < submodel.regressors.size(); ++i)
    if (rule.coefficients[static_cast<Eigen::Index>(i)] == 0.0)
      names += (names.empty() ? "" : ", ") + model.text(submodel.regressors[i]);
  return names;
}

}  // namespace

std::vector<RuleRemark> reportModel(const TsModel& model) {
  std::vector<RuleRemark> remarks;
  for (std::size_t i = 0; i < model.submodels.size(); ++i) {
    const OutputModel& submodel = model.submodels[i];
    for (std::size_t r = 0; r < submodel.rules.size(); ++r) {
      const auto remark = [&](const std::string& text) {
        remarks.push_back({model.outputs[i].name, r + 1, text});
      };
      const std::string zeros = zeroCoefficients(model, submodel, submodel.rules[r]);
      if (!zeros.empty()) remark("zero coefficients of " + zeros + ": rank-deficient fit");
      const double pole = largestPole(submodel, submodel.rules[r], static_cast<int>(i));
      if (pole >= kUnitCircle) remark("pole " + fixedText(pole) + ": drifts in free run");
    }
  }
  return remarks;
}

}  // namespace fpc
