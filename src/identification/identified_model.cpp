#include "identification/identified_model.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "identification/prediction.hpp"
#include "model/longest_lag.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kMostStarts =
    5000;  // of predictions n samples ahead: of longer records every so many

void clipToSensors(const IdentifiedModel& model, Matrix& predicted) {
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const IdentifiedOutput& o = model.outputs[i];
    if (!(o.sensor_lower < o.sensor_upper)) continue;
    for (Index k = 0; k < predicted.rows(); ++k) {
      double& y = predicted(k, static_cast<Index>(i));
      if (std::isfinite(y)) y = std::clamp(y, o.sensor_lower, o.sensor_upper);
    }
  }
}

ModelKind bestOf(const IdentifiedModel& model, std::size_t output) {
  return output < model.outputs.size() ? model.outputs[output].best : ModelKind::kRegressors;
}

/// Free runs of `reach` samples behind each other, each from measured ones.
Matrix shortRuns(const TsModel& model, const DataSet& data, Index reach) {
  const Index longest = longestLag(model);
  Matrix predicted = Matrix::Constant(data.rows(), static_cast<Index>(model.outputs.size()), kNaN);
  DataSet part = data;
  for (Index k = longest; k + 1 < data.rows(); k += reach) {
    const Index count = std::min(reach, data.rows() - 1 - k);
    part.values = data.values.middleRows(k - longest, longest + 1 + count);
    predicted.middleRows(k + 1, count) = predictFreeRun(model, part).bottomRows(count);
  }
  return predicted;
}

/// The TsModel `steps` samples ahead of every row, from its measured past.
Matrix stepsAhead(const TsModel& model, const DataSet& data, int steps) {
  const auto n_y = static_cast<Index>(model.outputs.size());
  Matrix predicted = Matrix::Constant(data.rows(), n_y, kNaN);
  const Index longest = longestLag(model);
  DataSet part = data;
  const Index stride = std::max<Index>(1, data.rows() / kMostStarts);
  for (Index k = longest; k + steps < data.rows(); k += stride) {
    part.values = data.values.middleRows(k - longest, longest + steps + 1);
    const Matrix run = predictFreeRun(model, part);
    predicted.row(k + steps) = run.row(longest + steps);
  }
  return predicted;
}

/// The free run plus the error expected `steps` samples later.
Vector correctedAhead(VectorRef measured, VectorRef free_run, const Vector& correction, int steps) {
  Vector y = Vector::Constant(free_run.size(), kNaN);
  const Index order = correction.size();
  for (Index k = order - 1; k + steps < y.size(); ++k) {
    Vector past = (measured - free_run).segment(k - order + 1, order).reverse();
    past = past.array().isFinite().select(past, 0.0);
    for (int n = 0; n < steps; ++n) {
      const double next = correction.dot(past);
      for (Index i = order - 1; i > 0; --i) past[i] = past[i - 1];
      past[0] = next;
    }
    y[k + steps] = free_run[k + steps] + past[0];
  }
  return y;
}

}  // namespace

TsModel IdentifiedModel::linearModel() const {
  TsModel l = model;
  l.name += "_linear";
  l.submodels = linear;
  return l;
}

bool IdentifiedModel::has(ModelKind kind) const {
  if (kind == ModelKind::kLinear) return !linear.empty();
  if (kind == ModelKind::kBlend)
    return has(ModelKind::kState) && std::any_of(outputs.begin(), outputs.end(), [](const auto& o) {
             return o.blend_free_run_width > 0.0;
           });
  return kind == ModelKind::kRegressors || !state.outputs.empty();
}

IdentifiedModel toIdentified(const AutoIdentification& found) {
  IdentifiedModel m{found.model, found.linear.submodels, found.state,
                    {},          found.same_row,         found.reach};
  for (const auto& o : found.outputs) {
    const AutoFigures& f = o.fuzzy_model ? o.regressors : o.linear;
    m.outputs.push_back({o.best, o.sensor_lower, o.sensor_upper, f.width, f.one_step_width});
    if (!o.fuzzy_model || o.blend.blocks.empty() || found.state.outputs.empty()) continue;
    m.outputs.back().blend_free_run_width = o.blend.width;
    m.outputs.back().blend_one_step_width = o.blend.one_step_width;
  }
  return m;
}

namespace {

/// Half of the regressors and half of the state.
KindPrediction predictBlend(const IdentifiedModel& model, const DataSet& data) {
  KindPrediction p = predictKind(model, ModelKind::kRegressors, data);
  const KindPrediction own = predictKind(model, ModelKind::kState, data);
  p.one_step = 0.5 * (p.one_step + own.one_step);
  p.free_run = 0.5 * (p.free_run + own.free_run);
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    p.one_step_width[static_cast<Index>(i)] = model.outputs[i].blend_one_step_width;
    p.free_run_width[static_cast<Index>(i)] = model.outputs[i].blend_free_run_width;
  }
  return p;
}

}  // namespace

KindPrediction predictKind(const IdentifiedModel& model, ModelKind kind, const DataSet& data) {
  require(model.has(kind), model.model.name, "a model of kind " + name(kind));
  if (kind == ModelKind::kBlend) return predictBlend(model, data);
  const auto n_y = static_cast<Index>(model.model.outputs.size());
  KindPrediction p;
  p.one_step_width = Vector::Zero(n_y);
  p.free_run_width = Vector::Zero(n_y);
  if (kind == ModelKind::kState) {
    p.one_step = predictOneStep(model.state, data);
    p.free_run = predictFreeRun(model.state, data);
    for (Index i = 0; i < n_y; ++i) {
      p.one_step_width[i] = model.state.outputs[static_cast<std::size_t>(i)].one_step_width;
      p.free_run_width[i] = model.state.outputs[static_cast<std::size_t>(i)].free_run_width;
    }
  } else {
    const TsModel ts = kind == ModelKind::kLinear ? model.linearModel() : model.model;
    p.one_step = predictOneStep(ts, data);
    p.free_run = model.reach > 0 ? shortRuns(ts, data, model.reach) : predictFreeRun(ts, data);
    for (std::size_t i = 0; kind == ModelKind::kRegressors && i < model.outputs.size(); ++i) {
      p.one_step_width[static_cast<Index>(i)] = model.outputs[i].one_step_width;
      p.free_run_width[static_cast<Index>(i)] = model.outputs[i].free_run_width;
    }
  }
  clipToSensors(model, p.one_step);
  clipToSensors(model, p.free_run);
  return p;
}

KindPrediction predictBest(const IdentifiedModel& model, const DataSet& data) {
  KindPrediction best = predictKind(model, ModelKind::kRegressors, data);
  for (const auto kind : {ModelKind::kLinear, ModelKind::kState, ModelKind::kBlend}) {
    if (!model.has(kind)) continue;
    const KindPrediction other = predictKind(model, kind, data);
    for (std::size_t i = 0; i < model.model.outputs.size(); ++i) {
      if (bestOf(model, i) != kind) continue;
      const auto c = static_cast<Index>(i);
      best.one_step.col(c) = other.one_step.col(c);
      best.free_run.col(c) = other.free_run.col(c);
      if (kind == ModelKind::kLinear) continue;  // the file's model is linear then: its widths
      best.one_step_width[c] = other.one_step_width[c];
      best.free_run_width[c] = other.free_run_width[c];
    }
  }
  return best;
}

AheadPrediction predictSteps(const IdentifiedModel& model, const DataSet& data, int steps) {
  AheadPrediction predicted;
  predicted.laws = stepsAhead(model.model, data, steps);
  predicted.best = predicted.laws;
  if (model.has(ModelKind::kState)) {
    const Matrix free_run = predictFreeRun(model.state, data);
    for (std::size_t i = 0; i < model.state.outputs.size(); ++i) {
      const ModelKind best = bestOf(model, i);
      if (best != ModelKind::kState && best != ModelKind::kBlend) continue;
      const auto c = static_cast<Index>(i);
      const Vector own = correctedAhead(data.values.col(c), free_run.col(c),
                                        model.state.outputs[i].correction, steps);
      auto column = predicted.best.col(c);
      column = best == ModelKind::kState ? own : Vector(0.5 * (column + own));
    }
  }
  clipToSensors(model, predicted.best);
  clipToSensors(model, predicted.laws);
  return predicted;
}

double coverage(VectorRef measured, VectorRef predicted, double width) {
  double inside = 0.0, n = 0.0;
  for (Index k = 0; k < measured.size(); ++k) {
    const double error = measured[k] - predicted[k];
    if (!std::isfinite(error)) continue;
    n += 1.0;
    if (std::abs(error) <= width) inside += 1.0;
  }
  return n > 0.0 && width > 0.0 ? 100.0 * inside / n : kNaN;
}

}  // namespace fpc
