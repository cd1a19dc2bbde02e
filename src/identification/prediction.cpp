#include "identification/prediction.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthestPrediction = 100.0;  // spans of the data

/// Evaluates submodels on a table of pasts.
class Predictor {
 public:
  Predictor(const TsModel& model, const DataSet& data) : model_(model), data_(data) {
    const auto same = [](const std::vector<SignalInfo>& a, const std::vector<SignalInfo>& b) {
      return a.size() == b.size() &&
             std::equal(a.begin(), a.end(), b.begin(),
                        [](const auto& s, const auto& t) { return s.name == t.name; });
    };
    require(same(model.outputs, data.outputs) && same(model.inputs, data.inputs) &&
                same(model.disturbances, data.disturbances),
            data.source, "the signals of the model, in its order");
    for (const auto& submodel : model.submodels) {
      antecedents_.emplace_back(static_cast<Index>(submodel.antecedents.size()));
      for (const auto* list : {&submodel.antecedents, &submodel.regressors})
        for (const auto& r : *list) longest_ = std::max(longest_, static_cast<Index>(r.lag));
    }
  }

  Index longest() const { return longest_; }

  /// y_i(k + 1) from the rows up to k of `past`; NaN if one is missing.
  double predict(std::size_t i, const Matrix& past, Index k) {
    const OutputModel& submodel = model_.submodels[i];
    if (k < longest_) return kNaN;
    Vector& z = antecedents_[i];
    for (std::size_t j = 0; j < submodel.antecedents.size(); ++j)
      z[static_cast<Index>(j)] = value(submodel.antecedents[j], past, k);
    if (!z.allFinite()) return kNaN;
    firingWeights(submodel, z, firing_);
    double sum = 0.0;
    for (std::size_t r = 0; r < submodel.rules.size(); ++r) {
      const double weight = firing_.weights[static_cast<Index>(r)];
      if (weight > 0.0) sum += weight * consequent(submodel, submodel.rules[r], past, k);
    }
    return sum;
  }

 private:
  double value(const Regressor& r, const Matrix& past, Index k) const {
    return past(k - r.lag, data_.column(r.kind, r.index));
  }
  double consequent(const OutputModel& submodel, const Rule& rule, const Matrix& past,
                    Index k) const {
    double sum = rule.offset;
    for (std::size_t j = 0; j < submodel.regressors.size(); ++j)
      sum += rule.coefficients[static_cast<Index>(j)] * value(submodel.regressors[j], past, k);
    return sum;
  }

  const TsModel& model_;
  const DataSet& data_;
  std::vector<Vector> antecedents_;
  FiringResult firing_;
  Index longest_{};
};

double clampToData(double value, const SignalInfo& signal) {
  if (!std::isfinite(signal.lower) || !std::isfinite(signal.upper)) return value;
  const double reach = kFarthestPrediction * (signal.upper - signal.lower);
  return std::clamp(value, signal.lower - reach, signal.upper + reach);
}

}  // namespace

Matrix predictOneStep(const TsModel& model, const DataSet& data) {
  Predictor predictor(model, data);
  Matrix predicted = Matrix::Constant(data.rows(), static_cast<Index>(model.outputs.size()), kNaN);
  for (Index k = 0; k + 1 < data.rows(); ++k)
    for (std::size_t i = 0; i < model.outputs.size(); ++i)
      predicted(k + 1, static_cast<Index>(i)) = predictor.predict(i, data.values, k);
  return predicted;
}

Matrix predictFreeRun(const TsModel& model, const DataSet& data) {
  Predictor predictor(model, data);
  const auto n_y = static_cast<Index>(model.outputs.size());
  Matrix predicted = Matrix::Constant(data.rows(), n_y, kNaN);
  Matrix past = data.values;  // outputs are replaced by predictions as the run goes on
  Vector next(n_y);
  for (Index k = predictor.longest(); k + 1 < data.rows(); ++k) {
    for (Index i = 0; i < n_y; ++i)
      next[i] = predictor.predict(static_cast<std::size_t>(i), past, k);
    if (!next.allFinite()) continue;  // past row k + 1 keeps the measured outputs: a new start
    for (Index i = 0; i < n_y; ++i)
      next[i] = clampToData(next[i], data.outputs[static_cast<std::size_t>(i)]);
    past.row(k + 1).head(n_y) = next.transpose();
    predicted.row(k + 1) = next.transpose();
  }
  return predicted;
}

FitFigures fitFigures(VectorRef measured, VectorRef predicted) {
  double n = 0.0, sum_y = 0.0, sum_e = 0.0;
  for (Index k = 0; k < measured.size(); ++k) {
    if (!std::isfinite(measured[k]) || !std::isfinite(predicted[k])) continue;
    n += 1.0;
    sum_y += measured[k];
    sum_e += measured[k] - predicted[k];
  }
  FitFigures figures;
  figures.samples = static_cast<Index>(n);
  if (figures.samples == 0) return figures;
  double square_e = 0.0, spread_e = 0.0, spread_y = 0.0;
  for (Index k = 0; k < measured.size(); ++k) {
    const double e = measured[k] - predicted[k];
    if (!std::isfinite(e)) continue;
    square_e += e * e;
    spread_e += (e - sum_e / n) * (e - sum_e / n);
    spread_y += (measured[k] - sum_y / n) * (measured[k] - sum_y / n);
  }
  figures.mse = square_e / n;
  figures.rmse = std::sqrt(figures.mse);
  if (spread_y > 0.0) {
    figures.vaf = 100.0 * (1.0 - spread_e / spread_y);
    figures.fit = 100.0 * (1.0 - std::sqrt(square_e / spread_y));
  }
  return figures;
}

}  // namespace fpc
