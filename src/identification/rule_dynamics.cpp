// Poles and steady-state gains of single rules.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>

#include "identification/validation.hpp"
#include "model/rule_poles.hpp"

namespace fpc {
namespace {

bool isOwn(const Regressor& r, std::size_t output) {
  return r.kind == SignalKind::kOutput && static_cast<std::size_t>(r.index) == output;
}

}  // namespace

std::vector<std::complex<double>> rulePoles(const OutputModel& model, const Rule& rule,
                                            std::size_t output) {
  int n_lags = 0;
  for (const auto& r : model.regressors)
    if (isOwn(r, output)) n_lags = std::max(n_lags, r.lag + 1);
  if (n_lags == 0) return {};
  Matrix companion = Matrix::Zero(n_lags, n_lags);
  companion.diagonal(-1).setOnes();
  for (std::size_t j = 0; j < model.regressors.size(); ++j)
    if (isOwn(model.regressors[j], output))
      companion(0, model.regressors[j].lag) += rule.coefficients[static_cast<Eigen::Index>(j)];
  const Eigen::VectorXcd values = Eigen::EigenSolver<Matrix>(companion, false).eigenvalues();
  std::vector<std::complex<double>> poles(values.data(), values.data() + values.size());
  std::sort(poles.begin(), poles.end(), [](const auto& a, const auto& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return poles;
}

namespace {

void addGains(const TsModel& names, const OutputModel& model, const Rule& rule, std::size_t output,
              RuleDynamics& dynamics) {
  double own = 0.0;
  std::map<std::string, double> sums;
  for (std::size_t j = 0; j < model.regressors.size(); ++j) {
    const Regressor& r = model.regressors[j];
    const double coefficient = rule.coefficients[static_cast<Eigen::Index>(j)];
    if (isOwn(r, output)) {
      own += coefficient;
      continue;
    }
    const std::string& name = names.signals(r.kind)[static_cast<std::size_t>(r.index)].name;
    if (sums.count(name) == 0) dynamics.signals.push_back(name);
    sums[name] += coefficient;
  }
  for (const auto& name : dynamics.signals)
    dynamics.gains.push_back(own == 1.0 ? std::numeric_limits<double>::infinity()
                                        : sums[name] / (1.0 - own));
}

}  // namespace

std::vector<RuleDynamics> ruleDynamics(const TsModel& model) {
  std::vector<RuleDynamics> all;
  for (std::size_t i = 0; i < model.submodels.size(); ++i)
    for (std::size_t r = 0; r < model.submodels[i].rules.size(); ++r) {
      const Rule& rule = model.submodels[i].rules[r];
      RuleDynamics dynamics;
      dynamics.output = model.outputs[i].name;
      dynamics.rule = r + 1;
      dynamics.data_count = rule.data_count;
      dynamics.poles = rulePoles(model.submodels[i], rule, i);
      addGains(model, model.submodels[i], rule, i, dynamics);
      all.push_back(dynamics);
    }
  return all;
}

}  // namespace fpc
