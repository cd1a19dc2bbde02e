#include "fmbpc/fuzzy/validation.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Two-sided quantile of the normal distribution, by Newton steps on erfc; from 0 they come from
/// the left for any confidence, because erfc is convex.
double normalQuantile(double confidence) {
  double z = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double excess = std::erfc(z / std::sqrt(2.0)) - (1.0 - confidence);
    z += excess / (std::sqrt(2.0 / 3.141592653589793) * std::exp(-0.5 * z * z));
  }
  return z;
}

/// Mean 0, mean square 1 over the finite elements; what is missing stays NaN.
Vector normalised(const Eigen::Ref<const Vector>& values) {
  double n = 0.0, sum = 0.0, square = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) n += 1.0, sum += v;
  const double mean = n > 0.0 ? sum / n : 0.0;
  for (const double v : values)
    if (std::isfinite(v)) square += (v - mean) * (v - mean);
  const double deviation = n > 0.0 ? std::sqrt(square / n) : 0.0;
  Vector result = Vector::Constant(values.size(), kNaN);
  for (Index k = 0; k < values.size(); ++k)
    if (std::isfinite(values[k]))
      result[k] = deviation > 0.0 ? (values[k] - mean) / deviation : 0.0;
  return result;
}

/// Mean of a(k) b(k - lag) over the samples where both are known.
double correlation(const Vector& a, const Vector& b, Index lag) {
  double n = 0.0, sum = 0.0;
  for (Index k = lag; k < a.size(); ++k) {
    const double product = a[k] * b[k - lag];
    if (std::isfinite(product)) n += 1.0, sum += product;
  }
  return n > 0.0 ? sum / n : 0.0;
}

std::vector<std::string> causeNames(const DataSet& data) {
  std::vector<std::string> names;
  for (const auto* signals : {&data.inputs, &data.disturbances})
    for (const auto& signal : *signals) names.push_back(signal.name);
  return names;
}

}  // namespace

ResidualCorrelation residualCorrelation(const DataSet& data,
                                        const Eigen::Ref<const Vector>& residual,
                                        const ValidationParams& params) {
  const Index n_lags = params.correlation_lags;
  const Vector e = normalised(residual);
  const auto known = static_cast<double>(e.array().isFinite().count());
  ResidualCorrelation result;
  result.bound = known > 0.0 ? normalQuantile(params.confidence) / std::sqrt(known) : 0.0;
  result.autocorrelation.resize(n_lags);
  for (Index lag = 1; lag <= n_lags; ++lag)
    result.autocorrelation[lag - 1] = correlation(e, e, lag);
  result.signals = causeNames(data);
  const auto n_causes = static_cast<Index>(result.signals.size());
  result.cross.resize(n_causes, n_lags + 1);
  for (Index j = 0; j < n_causes; ++j) {
    const Vector u = normalised(data.values.col(static_cast<Index>(data.outputs.size()) + j));
    for (Index lag = 0; lag <= n_lags; ++lag) result.cross(j, lag) = correlation(e, u, lag + 1);
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
