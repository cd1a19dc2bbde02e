// What a user should know of a Takagi-Sugeno model before trusting it: rank-deficient fits and
// rules that run away.
#include <cstdio>

#include "fmbpc/model/ts_model.hpp"
#include "model/rule_poles.hpp"

namespace fpc {
namespace {

constexpr double kUnitCircle = 1.0 - 1e-9;

std::string fixedText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

std::string zeroCoefficients(const TsModel& model, const OutputModel& submodel, const Rule& rule) {
  std::string names;
  for (std::size_t i = 0; i < submodel.regressors.size(); ++i)
    if (rule.coefficients[static_cast<Eigen::Index>(i)] == 0.0)
      names += (names.empty() ? "" : ", ") + model.text(submodel.regressors[i]);
  return names;
}

/// Variables that no value of which changes the degree.
std::string unusedAntecedents(const TsModel& model, const OutputModel& submodel, const Rule& rule) {
  std::string names;
  for (std::size_t i = 0; rule.multivariate && i < submodel.antecedents.size(); ++i)
    if (rule.multivariate->inverse_covariance.row(static_cast<Eigen::Index>(i)).isZero(0.0))
      names += (names.empty() ? "" : ", ") + model.text(submodel.antecedents[i]);
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
      const std::string unused = unusedAntecedents(model, submodel, submodel.rules[r]);
      if (!unused.empty()) remark("membership does not depend on " + unused);
      if (!zeros.empty()) remark("zero coefficients of " + zeros + ": rank-deficient fit");
      const auto poles = rulePoles(submodel, submodel.rules[r], i);
      const double pole = poles.empty() ? 0.0 : std::abs(poles.front());
      if (pole >= kUnitCircle) remark("pole " + fixedText(pole) + ": drifts in free run");
    }
  }
  return remarks;
}

}  // namespace fpc
