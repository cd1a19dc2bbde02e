// A plain constrained linear predictive controller (dynamic matrix control in moves) on the column:
// the baseline of the closed-loop paradigm. Same model, references, limits and horizon.
#pragma once

#include <vector>

#include "model/column_model.hpp"
#include "optim/qp.hpp"

namespace fpc::test {

struct PlainMpcSettings {
  int horizon{40}, moves{15};
  double move_weight{0.1};
  double input_limit{0.25}, move_limit{0.02}, pole{0.85};
  double output_penalty{1e4};
  Eigen::Vector2d target{1.0, -0.5};
  Eigen::Vector2d output_lower{-0.05, -0.55};
  Eigen::Vector2d output_upper{1.05, 0.05};
};

class PlainMpc {
 public:
  explicit PlainMpc(PlainMpcSettings settings)
      : s_(std::move(settings)), matrix_(columnMatrix()), input_(Vector::Zero(2)) {
    for (const auto& row : matrix_)
      for (const auto& e : row) lags_.emplace_back(e, 1.0);
    const Eigen::Index n = 2 * s_.moves, rows = 2 * s_.horizon;
    effect_ = Matrix::Zero(rows, n);  // rows (sample, output), columns (move, input)
    for (Eigen::Index j = 0; j < 2; ++j)
      for (Eigen::Index i = 0; i < 2; ++i) {
        const Fopdt& e = matrix_[index(i)][index(j)];
        LagResponse step(e, 1.0);
        std::vector<double> response;
        for (int k = 0; k < s_.horizon; ++k) response.push_back(e.gain * step.advance(1.0));
        for (Eigen::Index m = 0; m < s_.moves; ++m)
          for (Eigen::Index k = m; k < s_.horizon; ++k)
            effect_(2 * k + i, 2 * m + j) = response[index(k - m)];
      }
  }

  /// One sample on the exact model: returns the outputs (deviations) after it.
  Vector step() {
    reference_ = s_.pole * reference_ + (1.0 - s_.pole) * s_.target;
    decide();
    Vector y = Vector::Zero(2);
    for (Eigen::Index i = 0; i < 2; ++i)
      for (Eigen::Index j = 0; j < 2; ++j)
        y[i] += matrix_[index(i)][index(j)].gain * lags_[index(2 * i + j)].advance(input_[j]);
    return y;
  }
  const Vector& input() const { return input_; }
  bool failed() const { return failed_; }

 private:
  static std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }

  Vector freeResponse() const {
    Vector y = Vector::Zero(2 * s_.horizon);
    for (Eigen::Index i = 0; i < 2; ++i)
      for (Eigen::Index j = 0; j < 2; ++j) {
        LagResponse lag = lags_[index(2 * i + j)];
        const double gain = matrix_[index(i)][index(j)].gain;
        for (int k = 0; k < s_.horizon; ++k) y[2 * k + i] += gain * lag.advance(input_[j]);
      }
    return y;
  }

  void decide() {
    const Eigen::Index n = 2 * s_.moves, rows = 2 * s_.horizon;
    QpProblem qp(n + 2, n + 2 * rows);
    Vector error = freeResponse();
    Vector future = reference_;
    const Vector free = error;
    for (int k = 0; k < s_.horizon; ++k) {
      error.segment(2 * k, 2) -= future;
      future = s_.pole * future + (1.0 - s_.pole) * s_.target;
    }
    qp.H.topLeftCorner(n, n) = effect_.transpose() * effect_;
    qp.H.diagonal().head(n).array() += s_.move_weight;
    qp.H.diagonal().tail(2).setConstant(s_.output_penalty);
    qp.g.head(n) = effect_.transpose() * error;
    qp.x_lower.head(n).setConstant(-s_.move_limit);
    qp.x_upper.head(n).setConstant(s_.move_limit);
    qp.x_lower.tail(2).setZero();
    for (Eigen::Index m = 0; m < s_.moves; ++m)
      for (Eigen::Index j = 0; j < 2; ++j) {
        for (Eigen::Index p = 0; p <= m; ++p) qp.A(2 * m + j, 2 * p + j) = 1.0;
        qp.a_lower[2 * m + j] = -s_.input_limit - input_[j];
        qp.a_upper[2 * m + j] = s_.input_limit - input_[j];
      }
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Eigen::Index o = r % 2, upper = n + r, lower = n + rows + r;
      if (effect_.row(r).isZero(0.0)) continue;  // before the dead time no input helps
      qp.A.row(upper).head(n) = qp.A.row(lower).head(n) = effect_.row(r);
      qp.A(upper, n + o) = -1.0;
      qp.A(lower, n + o) = 1.0;
      qp.a_upper[upper] = s_.output_upper[o] - free[r];
      qp.a_lower[lower] = s_.output_lower[o] - free[r];
    }
    QpSolver solver(n + 2, n + 2 * rows);
    const QpResult& result = solver.solve(qp);
    failed_ = failed_ || !result.usable();
    if (result.usable()) input_ += result.x.head(2);
  }

  PlainMpcSettings s_;
  FopdtMatrix matrix_;
  std::vector<LagResponse> lags_;
  Matrix effect_;
  Vector input_, reference_ = Vector::Zero(2);
  bool failed_{false};
};

}  // namespace fpc::test
