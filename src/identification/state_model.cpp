#include "identification/state_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/known_stretches.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kCorrectionOrder = 4;

RecurrentData recordOf(const StateOutput& model, const StateMember& member, const DataSet& data,
                       Index output) {
  RecurrentData record;
  record.y =
      (data.values.col(output).array() - (member.shape.absolute ? 0.0 : model.shift)) / model.scale;
  record.v.resize(static_cast<Index>(member.exogenous.size()), data.rows());
  const auto n_y = static_cast<Index>(data.outputs.size());
  for (std::size_t j = 0; j < member.exogenous.size(); ++j) {
    const Regressor& r = member.exogenous[j];
    const Index column = data.column(r.kind, r.index), own = column - n_y;
    for (Index k = 0; k < data.rows(); ++k)
      record.v(static_cast<Index>(j), k) =
          (data.values(std::max<Index>(k - r.lag, 0), column) - model.exogenous_shift[own]) /
          model.exogenous_scale[own];
  }
  return record;
}

Vector freeRunOf(const StateOutput& model, const DataSet& data, Index output, int window) {
  std::vector<Vector> runs;
  const auto stretches = knownStretches(data);
  for (const auto& member : model.members) {
    const RecurrentData record = recordOf(model, member, data, output);
    Vector run = Vector::Constant(data.rows(), kNaN);
    for (const auto& s : stretches) {
      const Vector part =
          runRecurrent(member.shape, record, s, member.parameters, member.prior, window);
      run.segment(s.first, s.last - s.first) = part.segment(s.first, s.last - s.first);
    }
    runs.push_back(run * model.scale +
                   Vector::Constant(data.rows(), member.shape.absolute ? 0.0 : model.shift));
  }
  Vector y = Vector::Constant(data.rows(), kNaN);
  for (const auto& s : stretches)
    for (Index k = s.first + window; k < s.last; ++k) {
      std::vector<double> said;
      for (const auto& run : runs)
        if (std::isfinite(run[k])) said.push_back(run[k]);
      if (!said.empty()) y[k] = trimmedMean(said);
    }
  return y;
}

void checkMember(const StateMember& m, const TsModel& names) {
  const RecurrentShape& s = m.shape;
  require(s.states >= 1 && s.states <= 20 && s.rules >= 1, "state model", "1 to 20 states, rules");
  require(static_cast<Index>(m.exogenous.size()) == s.exogenous, "state model: inputs",
          "as many as its shape says");
  for (const auto& r : m.exogenous)
    require(r.kind != SignalKind::kOutput && r.index >= 0 &&
                static_cast<std::size_t>(r.index) < names.signals(r.kind).size() && r.lag >= 0,
            "state model: inputs", "inputs or disturbances of this model");
  for (const auto* list : {&s.regressors, &s.antecedents})
    for (const Index i : *list)
      require(i >= 0 && i < s.states + s.exogenous, "state model", "indices of its variables");
  require(m.parameters.size() == s.parameterCount() && m.parameters.allFinite(),
          "state model: parameters", std::to_string(s.parameterCount()) + " finite numbers");
  const StartPrior& p = m.prior;
  require(s.companion || (p.mean.size() == s.states && p.covariance.rows() == s.states &&
                          p.covariance.cols() == s.states && p.lower.size() == s.states &&
                          p.upper.size() == s.states && p.noise > 0.0),
          "state model: start", "mean, covariance and limits of all states, noise > 0");
}

}  // namespace

void StateModel::validate(const TsModel& names) const {
  require(outputs.empty() || outputs.size() == names.outputs.size(), "state model",
          "one part for each output");
  const auto m = static_cast<Index>(names.inputs.size() + names.disturbances.size());
  for (const auto& output : outputs) {
    require(!output.members.empty(), "state model", "at least one member for each output");
    require(output.scale > 0.0 && std::isfinite(output.shift) &&
                output.exogenous_shift.size() == m && output.exogenous_scale.size() == m &&
                (output.exogenous_scale.array() > 0.0).all() && output.correction.allFinite(),
            "state model", "finite scaling of every signal");
    for (const auto& member : output.members) checkMember(member, names);
  }
}

double trimmedMean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() > 2 ? (values.size() + 1) / 4 : 0;
  double sum = 0.0;
  for (std::size_t i = cut; i + cut < values.size(); ++i) sum += values[i];
  return sum / static_cast<double>(values.size() - 2 * cut);
}

Vector fitCorrection(VectorRef errors) {
  Matrix H = Matrix::Zero(kCorrectionOrder, kCorrectionOrder);
  Vector g = Vector::Zero(kCorrectionOrder);
  for (Index k = kCorrectionOrder - 1; k + 1 < errors.size(); ++k) {
    const Vector past = errors.segment(k - kCorrectionOrder + 1, kCorrectionOrder).reverse();
    if (!past.allFinite() || !std::isfinite(errors[k + 1])) continue;
    H += past * past.transpose();
    g += past * errors[k + 1];
  }
  H.diagonal().array() += 1e-6 * H.trace() + 1e-300;
  const Vector theta = H.ldlt().solve(g);
  return theta.allFinite() ? theta : Vector::Zero(kCorrectionOrder);
}

Vector corrected(VectorRef measured, VectorRef free_run, const Vector& correction) {
  Vector y = free_run;
  for (Index k = 0; k + 1 < y.size(); ++k) {
    double shift = 0.0;
    for (Index i = 0; i < correction.size() && k - i >= 0; ++i) {
      const double error = measured[k - i] - free_run[k - i];
      if (std::isfinite(error)) shift += correction[i] * error;
    }
    y[k + 1] += shift;
  }
  return y;
}

Matrix predictFreeRun(const StateModel& model, const DataSet& data, int window) {
  Matrix predicted(data.rows(), static_cast<Index>(model.outputs.size()));
  for (Index i = 0; i < predicted.cols(); ++i)
    predicted.col(i) = freeRunOf(model.outputs[static_cast<std::size_t>(i)], data, i, window);
  return predicted;
}

Matrix predictOneStep(const StateModel& model, const DataSet& data, int window) {
  Matrix predicted = predictFreeRun(model, data, window);
  for (Index i = 0; i < predicted.cols(); ++i) {
    const StateOutput& output = model.outputs[static_cast<std::size_t>(i)];
    predicted.col(i) = corrected(data.values.col(i), predicted.col(i), output.correction).eval();
    double lowest = -std::numeric_limits<double>::infinity(), highest = -lowest;
    const RecurrentShape& shape = output.members.front().shape;
    const double zero = shape.absolute ? 0.0 : output.shift;
    if (shape.lower < shape.upper) {
      lowest = zero + output.scale * shape.lower;
      highest = zero + output.scale * shape.upper;
    }
    for (Index k = 0; k < predicted.rows(); ++k)
      if (std::isfinite(predicted(k, i)))
        predicted(k, i) = std::clamp(predicted(k, i), lowest, highest);
  }
  return predicted;
}

}  // namespace fpc
