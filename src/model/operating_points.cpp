#include "model/operating_points.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kMostRestSamples = 20000;
constexpr double kSettledRest = 1e-10;  // of an output's range, per sample
constexpr double kAwayFromRest = 10.0;  // ranges
constexpr double kEdge = 0.1;           // of an input's range
constexpr double kTinyPole = 1e-6;
constexpr int kFewestStepSamples = 20, kMostStepSamples = 2000;

bool allRanges(const std::vector<SignalInfo>& signals) {
  return std::all_of(signals.begin(), signals.end(), [](const SignalInfo& s) {
    return std::isfinite(s.lower) && std::isfinite(s.upper);
  });
}

Vector middleOf(const std::vector<SignalInfo>& signals) {
  Vector middle(static_cast<Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i)
    middle[static_cast<Index>(i)] = 0.5 * (signals[i].lower + signals[i].upper);
  return middle;
}

/// Runs the model under constant inputs until its outputs rest. @return false: they never do.
bool settle(LocalModel& local, const OperatingPoint& at, Vector& state) {
  const TsModel& model = local.model();
  const auto n_y = static_cast<Index>(model.outputs.size());
  Vector next(state.size());
  int still = 0;
  for (int k = 0; k < kMostRestSamples; ++k) {
    local.advance(state, at.inputs, at.disturbances, next);
    bool rests = true;
    for (Index i = 0; i < n_y; ++i) {
      const SignalInfo& y = model.outputs[static_cast<std::size_t>(i)];
      const double span = y.upper - y.lower, value = next[local.outputState(i)];
      if (!(std::abs(value - 0.5 * (y.lower + y.upper)) < kAwayFromRest * span)) return false;
      rests = rests && std::abs(value - state[local.outputState(i)]) < kSettledRest * span;
    }
    state = next;
    still = rests ? still + 1 : 0;
    if (still > static_cast<int>(state.size())) return true;
  }
  return false;
}

void addPoles(const Matrix& A, double sample_time_s, OperatingPoint& point) {
  const Eigen::VectorXcd values = eigenOf(A).eigenvalues();
  for (const auto& pole : values)
    if (std::abs(pole) > kTinyPole) point.poles.push_back(pole);
  std::sort(point.poles.begin(), point.poles.end(), [](const auto& a, const auto& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  for (const auto& pole : point.poles) {
    const double size = std::abs(pole);
    const bool counts = pole.imag() > 0.0 || (pole.imag() == 0.0 && pole.real() > 0.0);
    if (counts && size < 1.0 - 1e-9)
      point.time_constants_s.push_back(-sample_time_s / std::log(size));
  }
}

int stepSamples(const OperatingPoint& point, double sample_time_s) {
  const double longest =
      point.time_constants_s.empty() ? 0.0 : point.time_constants_s.front() / sample_time_s;
  return static_cast<int>(std::clamp(5.0 * longest, static_cast<double>(kFewestStepSamples),
                                     static_cast<double>(kMostStepSamples)));
}

void linearise(LocalModel& local, const Vector& state, int samples, OperatingPoint& point) {
  const TsModel& model = local.model();
  const auto n_y = static_cast<Index>(model.outputs.size()),
             n_u = static_cast<Index>(model.inputs.size()), n_x = local.stateSize();
  local.blend(state, point.inputs, point.disturbances);
  Matrix A = local.affine().A, B = local.affine().B;
  Matrix slope_A = Matrix::Zero(n_x, n_x), slope_B = Matrix::Zero(n_x, n_u);
  local.addSlopes(state, point.inputs, point.disturbances, slope_A, slope_B);
  A += slope_A;
  B += slope_B;
  const Index n_past = n_u > 0 ? local.inputState(0, 1) : n_x;  // outputs' pasts stand first
  addPoles(A.topLeftCorner(n_past, n_past), model.sample_time_s, point);
  Matrix C = Matrix::Zero(n_y, n_x);
  for (Index i = 0; i < n_y; ++i) C(i, local.outputState(i)) = 1.0;
  const Eigen::FullPivLU<Matrix> rest(Matrix::Identity(n_x, n_x) - A);
  const bool integrates = std::any_of(point.poles.begin(), point.poles.end(),
                                      [](const auto& p) { return std::abs(p - 1.0) < 1e-9; });
  point.gains = integrates ? Matrix::Constant(n_y, n_u, kInfinity) : (C * rest.solve(B)).eval();
  const int n = samples > 0 ? samples : stepSamples(point, model.sample_time_s);
  for (Index j = 0; j < n_u; ++j) {
    Matrix& step = point.steps.emplace_back(n, n_y);
    Vector x = Vector::Zero(n_x);
    for (Index k = 0; k < n; ++k) {
      step.row(k) = (C * x).transpose();
      x = A * x + B.col(j);
    }
  }
}

}  // namespace

std::vector<OperatingPoint> operatingPoints(const TsModel& model, int samples) {
  model.validate();
  std::vector<OperatingPoint> points;
  if (!allRanges(model.outputs) || !allRanges(model.inputs) || !allRanges(model.disturbances))
    return points;
  LocalModel local(model);
  OperatingPoint middle;
  middle.name = "middle";
  middle.inputs = middleOf(model.inputs);
  middle.disturbances = middleOf(model.disturbances);
  points.push_back(middle);
  for (std::size_t j = 0; j < model.inputs.size(); ++j)
    for (const bool high : {false, true}) {
      const SignalInfo& u = model.inputs[j];
      OperatingPoint point = middle;
      point.name = u.name + (high ? " high" : " low");
      point.inputs[static_cast<Index>(j)] =
          u.lower + (high ? 1.0 - kEdge : kEdge) * (u.upper - u.lower);
      points.push_back(point);
    }
  for (auto& point : points) {
    Vector state(local.stateSize());
    const Vector outputs = middleOf(model.outputs);
    local.restState(outputs, point.inputs, point.disturbances, state);
    const Vector begun = state;
    point.rests = settle(local, point, state);
    if (!point.rests) state = begun;
    point.outputs.resize(outputs.size());
    for (Index i = 0; i < outputs.size(); ++i) point.outputs[i] = state[local.outputState(i)];
    linearise(local, state, samples, point);
  }
  return points;
}

Eigen::MatrixXi deadTimes(const TsModel& model) {
  const auto n_y = static_cast<Index>(model.outputs.size()),
             n_u = static_cast<Index>(model.inputs.size());
  constexpr int kNever = 1 << 20;
  Eigen::MatrixXi through = Eigen::MatrixXi::Constant(n_y, n_y, kNever);
  Eigen::MatrixXi dead = Eigen::MatrixXi::Constant(n_y, n_u, kNever);
  for (Index i = 0; i < n_y; ++i)
    for (const auto& r : model.submodels[static_cast<std::size_t>(i)].regressors) {
      if (r.kind == SignalKind::kOutput)
        through(i, r.index) = std::min(through(i, r.index), r.lag + 1);
      if (r.kind == SignalKind::kInput) dead(i, r.index) = std::min(dead(i, r.index), r.lag + 1);
    }
  for (Index pass = 0; pass < n_y; ++pass)
    for (Index i = 0; i < n_y; ++i)
      for (Index o = 0; o < n_y; ++o)
        for (Index j = 0; o != i && j < n_u; ++j)
          dead(i, j) = std::min(dead(i, j), std::min(through(i, o) + dead(o, j), kNever));
  return (dead.array() >= kNever).select(-1, dead);
}

}  // namespace fpc
