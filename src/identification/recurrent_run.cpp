// Free runs of a recursion and the estimate of where a hidden state starts.
#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "identification/recurrent_fit.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthestState = 30.0;
constexpr int kStartSteps = 8;

/// A start and how badly it explains the first samples.
struct StartGuess {
  Vector x;
  double misfit{};
};

/// Most probable start given the first samples, by Gauss-Newton steps from `x0`.
StartGuess improveStart(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                        const Vector& p, const StartPrior& prior, int window, Vector x0) {
  const Index n = shape.states;
  RecurrentStep step(shape);
  const Matrix precision = prior.covariance.ldlt().solve(Matrix::Identity(n, n));
  const double weight = 1.0 / (prior.noise * prior.noise);
  StartGuess guess{x0, std::numeric_limits<double>::infinity()};
  for (int i = 0; i <= kStartSteps; ++i) {
    const Vector away = prior.mean - x0;
    Vector x = x0, next(n), gradient = precision * away;
    double misfit = away.dot(gradient);
    Matrix hessian = precision, s = Matrix::Zero(n, shape.parameterCount() + n);
    s.rightCols(n).setIdentity();
    for (Index k = stretch.first; k < std::min(stretch.first + window, stretch.last); ++k) {
      if (std::isfinite(data.y[k])) {
        const double sign = shape.absolute && x[0] < 0.0 ? -1.0 : 1.0;
        const Vector row = sign * s.row(0).tail(n).transpose();
        const double error = data.y[k] - sign * x[0];
        misfit += weight * error * error;
        gradient += weight * error * row;
        hessian += weight * row * row.transpose();
      }
      if (!data.v.col(k).allFinite()) break;
      step.predict(p, x, data.v.col(k), next);
      step.differentiate(p, s);
      x = next;
    }
    if (misfit < guess.misfit) guess = {x0, misfit};
    const Vector move = hessian.ldlt().solve(gradient);
    if (!move.allFinite()) break;
    x0 += move;
  }
  return guess;
}

Vector estimateStart(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                     const Vector& p, const StartPrior& prior, int window) {
  const double first = data.y[stretch.first];
  const auto startAt = [&](double y) {
    Vector x = prior.mean;
    if (std::isfinite(y) && prior.covariance(0, 0) > 0.0)
      x += prior.covariance.col(0) / prior.covariance(0, 0) * (y - x[0]);
    return improveStart(shape, data, stretch, p, prior, window, x);
  };
  const StartGuess above = startAt(first);
  if (!shape.absolute) return above.x;
  const StartGuess below = startAt(-first);  // the sign is hidden
  return below.misfit < above.misfit ? below.x : above.x;
}

}  // namespace

Vector runRecurrent(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                    const Vector& p, const StartPrior& prior, int window) {
  const Index n = shape.states;
  Vector y = Vector::Constant(data.y.size(), std::numeric_limits<double>::quiet_NaN());
  RecurrentStep step(shape);
  Vector x = Vector::Zero(n), next(n);
  const bool held = prior.lower.size() == n;
  const Vector lower = held ? prior.lower : Vector::Constant(n, -kFarthestState).eval();
  const Vector upper = held ? prior.upper : Vector::Constant(n, kFarthestState).eval();
  bool started = !shape.companion;
  if (started) {
    x = estimateStart(shape, data, stretch, p, prior, window);
    y[stretch.first] = shape.output(x[0]);
  }
  for (Index k = stretch.first; k + 1 < stretch.last; ++k) {
    if (!data.v.col(k).allFinite()) {
      started = !shape.companion;
      continue;
    }
    if (!started) {
      if (k - stretch.first + 1 < n) continue;
      for (Index j = 0; j < n; ++j) x[j] = data.y[k - j];
      if (!x.allFinite()) continue;
      started = true;
    }
    step.predict(p, x, data.v.col(k), next);
    x = next.cwiseMax(lower).cwiseMin(upper);
    y[k + 1] = shape.output(x[0]);
  }
  return y;
}

Matrix statesOf(const RecurrentShape& shape, const RecurrentData& data, Stretch stretch,
                const Vector& p, const Vector& start) {
  Matrix states(shape.states, stretch.last - stretch.first);
  RecurrentStep step(shape);
  Vector x = start, next(shape.states);
  for (Index k = stretch.first; k < stretch.last; ++k) {
    states.col(k - stretch.first) = x;
    if (!data.v.col(k).allFinite()) continue;
    step.predict(p, x, data.v.col(k), next);
    x = next.cwiseMax(-kFarthestState).cwiseMin(kFarthestState);
  }
  return states;
}

}  // namespace fpc
