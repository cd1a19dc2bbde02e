#include "model/rule_poles.hpp"

#include <algorithm>

#include "base/decompositions.hpp"

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
  const Eigen::VectorXcd values = eigenOf(companion).eigenvalues();
  std::vector<std::complex<double>> poles(values.data(), values.data() + values.size());
  std::sort(poles.begin(), poles.end(), [](const auto& a, const auto& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return poles;
}

}  // namespace fpc
