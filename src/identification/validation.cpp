#include "identification/validation.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Correlation of a(k) with b(k - lag) over the samples where both are known, each without its mean
/// over these: within -1..1. Its deviation shrinks with the samples as that of lag 0: `known` is
/// what the bound was made for.
double correlation(const Eigen::Ref<const Vector>& a, const Eigen::Ref<const Vector>& b, Index lag,
                   double known) {
  double n = 0.0, sa = 0.0, sb = 0.0;
  for (Index k = lag; k < a.size(); ++k)
    if (std::isfinite(a[k]) && std::isfinite(b[k - lag])) n += 1.0, sa += a[k], sb += b[k - lag];
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (Index k = lag; k < a.size(); ++k) {
    const double x = a[k] - sa / n, y = b[k - lag] - sb / n;
    if (std::isfinite(x) && std::isfinite(y)) aa += x * x, bb += y * y, ab += x * y;
  }
  const double spread = std::sqrt(aa) * std::sqrt(bb);
  return spread > 0.0 ? ab / spread * std::sqrt(std::min(1.0, n / known)) : 0.0;
}

std::vector<std::string> causeNames(const DataSet& data) {
  std::vector<std::string> names;
  for (const auto* signals : {&data.inputs, &data.disturbances})
    for (const auto& signal : *signals) names.push_back(signal.name);
  return names;
}

}  // namespace

Vector autocorrelation(const Eigen::Ref<const Vector>& values, const ValidationParams& params) {
  const auto known = static_cast<double>(values.array().isFinite().count());
  Vector result(params.correlation_lags);
  for (Index lag = 1; lag <= result.size(); ++lag)
    result[lag - 1] = correlation(values, values, lag, known);
  return result;
}

ResidualCorrelation residualCorrelation(const DataSet& data,
                                        const Eigen::Ref<const Vector>& residual,
                                        const ValidationParams& params) {
  const Index n_lags = params.correlation_lags;
  const auto known = static_cast<double>(residual.array().isFinite().count());
  ResidualCorrelation result;
  result.bound = known > 0.0 ? normalBound(params.confidence) / std::sqrt(known) : 0.0;
  result.autocorrelation = autocorrelation(residual, params);
  result.signals = causeNames(data);
  const auto n_causes = static_cast<Index>(result.signals.size());
  result.cross.resize(n_causes, n_lags + 1);
  for (Index j = 0; j < n_causes; ++j) {
    const auto u = data.values.col(static_cast<Index>(data.outputs.size()) + j);
    for (Index lag = 0; lag <= n_lags; ++lag)
      result.cross(j, lag) = correlation(residual, u, lag + 1, known);
  }
  const auto beyond = (result.autocorrelation.array().abs() > result.bound).count() +
                      (result.cross.array().abs() > result.bound).count();
  result.outside =
      static_cast<double>(beyond) / static_cast<double>(n_lags + n_causes * (n_lags + 1));
  return result;
}

std::vector<OutputValidation> validateModel(const TsModel& model, const TsModel& linear,
                                            const DataSet& data, const ValidationParams& params) {
  const Matrix one_step = predictOneStep(model, data), free_run = predictFreeRun(model, data);
  const Matrix linear_one_step = predictOneStep(linear, data),
               linear_free_run = predictFreeRun(linear, data);
  std::vector<OutputValidation> result;
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const Vector measured = data.values.col(column);
    OutputValidation validation;
    validation.output = model.outputs[i].name;
    validation.one_step = fitFigures(measured, one_step.col(column));
    validation.free_run = fitFigures(measured, free_run.col(column));
    validation.linear_one_step = fitFigures(measured, linear_one_step.col(column));
    validation.linear_free_run = fitFigures(measured, linear_free_run.col(column));
    validation.residual = residualCorrelation(data, measured - one_step.col(column), params);
    result.push_back(validation);
  }
  return result;
}

}  // namespace fpc
