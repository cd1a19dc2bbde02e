#include "control/clp/limits.hpp"

#include <algorithm>
#include <cmath>

#include "control/clp/closed_loop_paradigm.hpp"
#include "control/power_of_two.hpp"

namespace fpc {
namespace {

bool inside(VectorRef value, VectorRef lower, VectorRef upper) {
  return (value.array() >= lower.array()).all() && (value.array() <= upper.array()).all();
}

}  // namespace

ClpLimits::ClpLimits(const ClpParams& params, const InputLimits& limits, const ClpSizes& s)
    : sizes_(s),
      limits_(limits),
      output_lower_(params.output_lower),
      output_upper_(params.output_upper),
      stated_lower_(params.output_lower),
      stated_upper_(params.output_upper),
      output_weight_(params.output_weight),
      increment_lower_(params.increment_lower),
      increment_upper_(params.increment_upper),
      incremental_(params.bounds == ClpBounds::kIncremental),
      penalty_(params.output_penalty),
      lower_(s.n_u),
      upper_(s.n_u),
      first_lower_(s.n_u),
      first_upper_(s.n_u) {
  for (Eigen::Index a = 0; a < s.n_u && !incremental_; ++a) {
    if (std::isfinite(limits_.move[a])) limited_moves_.push_back(a);
  }
  n_rows_ = static_cast<Eigen::Index>(limited_moves_.size()) * (s.n_c - 1);
  for (Eigen::Index o = 0; o < s.n_y; ++o) {
    const int sides = std::isfinite(output_lower_[o]) + std::isfinite(output_upper_[o]);
    if (sides > 0) limited_outputs_.push_back(o);
    n_rows_ += sides * s.n_c;
  }
  n_slacks_ = static_cast<Eigen::Index>(limited_outputs_.size());
}

void ClpLimits::prepare(ClpProblem& problem) const {
  const Eigen::Index n_u = sizes_.n_u;
  problem.input_scale.resize(n_u);
  for (Eigen::Index a = 0; a < n_u; ++a) {
    problem.input_scale[a] = powerOfTwoNear(limits_.upper[a] - limits_.lower[a]);
  }
  problem.slack_scale = Vector::Ones(n_slacks_);
  QpProblem& qp = problem.qp;
  qp.x_lower.tail(n_slacks_).setZero();
  qp.H.diagonal().tail(n_slacks_).setConstant(penalty_);
  for (std::size_t s = 0; s < limited_outputs_.size(); ++s) {
    const auto slack = sizes_.inputs() + static_cast<Eigen::Index>(s);
    qp.H(slack, slack) *= output_weight_[limited_outputs_[s]];
  }
  Eigen::Index row = 0;
  for (const Eigen::Index a : limited_moves_) {
    for (Eigen::Index i = 1; i < sizes_.n_c; ++i, ++row) {
      qp.A(row, i * n_u + a) = 1.0;
      qp.A(row, (i - 1) * n_u + a) = -1.0;
      qp.a_upper[row] = limits_.move[a] / problem.input_scale[a];
      qp.a_lower[row] = -qp.a_upper[row];
    }
  }
  fillSlackColumns(problem);
}

void ClpLimits::fillSlackColumns(ClpProblem& problem) const {
  Matrix& A = problem.qp.A;
  Eigen::Index row = static_cast<Eigen::Index>(limited_moves_.size()) * (sizes_.n_c - 1);
  Eigen::Index slack = sizes_.inputs();
  const auto side = [&](bool limited, double sign, Eigen::Index count) {
    if (!limited) return;
    A.col(slack).segment(row, count).setConstant(sign);
    row += count;
  };
  for (const Eigen::Index o : limited_outputs_) {
    side(std::isfinite(output_upper_[o]), -1.0, sizes_.n_c);
    side(std::isfinite(output_lower_[o]), 1.0, sizes_.n_c);
    ++slack;
  }
}

void ClpLimits::set(const PredictiveAction& now, VectorRef u_ss) {
  lower_ = limits_.lower;
  upper_ = limits_.upper;
  if (incremental_) {
    lower_ = u_ss + increment_lower_;
    upper_ = u_ss + increment_upper_;
  }
  first_lower_ = lower_;
  first_upper_ = upper_;
  bound_wins_ = false;
  for (const Eigen::Index a : limited_moves_) {
    const double reach_lower = now.input_previous[a] - limits_.move[a];
    const double reach_upper = now.input_previous[a] + limits_.move[a];
    bound_wins_ = bound_wins_ || reach_lower > upper_[a] || reach_upper < lower_[a];
    first_lower_[a] = std::clamp(reach_lower, lower_[a], upper_[a]);
    first_upper_[a] = std::clamp(reach_upper, lower_[a], upper_[a]);
  }
  const bool zones = now.output_lower.size() > 0;
  for (const Eigen::Index o : limited_outputs_) {
    output_lower_[o] = stated_lower_[o];
    output_upper_[o] = stated_upper_[o];
    if (zones && std::isfinite(stated_lower_[o]) && std::isfinite(now.output_lower[o]))
      output_lower_[o] = now.output_lower[o];
    if (zones && std::isfinite(stated_upper_[o]) && std::isfinite(now.output_upper[o]))
      output_upper_[o] = now.output_upper[o];
  }
  for (Eigen::Index a = 0; a < now.input_lower.size(); ++a) {
    first_lower_[a] = std::clamp(now.input_lower[a], first_lower_[a], first_upper_[a]);
    first_upper_[a] = std::clamp(now.input_upper[a], first_lower_[a], first_upper_[a]);
  }
}

bool ClpLimits::admitsFirst(VectorRef input) const {
  return inside(input, first_lower_, first_upper_);
}

bool ClpLimits::admitsNext(VectorRef input, VectorRef previous) const {
  for (const Eigen::Index a : limited_moves_) {
    if (!(std::abs(input[a] - previous[a]) <= limits_.move[a])) return false;
  }
  return inside(input, lower_, upper_);
}

bool ClpLimits::admitsOutput(VectorRef output) const {
  return inside(output, output_lower_, output_upper_);
}

void ClpLimits::fill(const PredictiveAction& now, const ClpPrediction& prediction,
                     ClpProblem& problem) {
  const Eigen::Index n_u = sizes_.n_u;
  QpProblem& qp = problem.qp;
  for (Eigen::Index i = 0; i < sizes_.n_c; ++i) {
    const Vector& low = i == 0 ? first_lower_ : lower_;
    const Vector& high = i == 0 ? first_upper_ : upper_;
    qp.x_lower.segment(i * n_u, n_u) = low.cwiseQuotient(problem.input_scale);
    qp.x_upper.segment(i * n_u, n_u) = high.cwiseQuotient(problem.input_scale);
  }
  Eigen::Index row = static_cast<Eigen::Index>(limited_moves_.size()) * (sizes_.n_c - 1);
  for (std::size_t s = 0; s < limited_outputs_.size(); ++s) {
    row = fillOutput(now, prediction, static_cast<Eigen::Index>(s), row, problem);
  }
}

Eigen::Index ClpLimits::fillOutput(const PredictiveAction& now, const ClpPrediction& prediction,
                                   Eigen::Index slack, Eigen::Index row,
                                   ClpProblem& problem) const {
  const Eigen::Index n_u = sizes_.n_u, n_c = sizes_.n_c;
  const Eigen::Index o = limited_outputs_[static_cast<std::size_t>(slack)];
  const auto pulse = prediction.output_pulse.row(o);
  double response =
      0.0;  // of the output, one unit: its largest answer to one pulse of one input scale
  for (Eigen::Index p = 0; p < pulse.size(); ++p) {
    response = std::max(response, std::abs(pulse[p]) * problem.input_scale[p % n_u]);
  }
  const double unit = problem.slack_scale[slack] = powerOfTwoNear(response);
  QpProblem& qp = problem.qp;
  for (const bool upper : {true, false}) {
    const double limit = upper ? output_upper_[o] : output_lower_[o];
    if (!std::isfinite(limit)) continue;
    for (Eigen::Index p = 0; p < sizes_.inputs(); ++p) {
      const Eigen::Index first = p / n_u;  // the first sample that input p reaches
      const double factor = problem.input_scale[p % n_u] / unit;
      for (Eigen::Index i = first; i < n_c; ++i)
        qp.A(row + i, p) = factor * pulse[p + (i - 2 * first) * n_u];
    }
    bool reached =
        false;  // before the dead time no input helps: such a row would only hold the slack open
    for (Eigen::Index i = 0; i < n_c; ++i) {
      reached = reached || !pulse.segment(i * n_u, n_u).isZero(0.0);
      const double y_free =
          now.C.row(o).dot(prediction.state_free.col(i + 1)) + now.offset_output[o];
      qp.a_upper[row + i] = upper && reached ? (limit - y_free) / unit : kInfinity;
      qp.a_lower[row + i] = !upper && reached ? (limit - y_free) / unit : -kInfinity;
    }
    row += n_c;
  }
  return row;
}

}  // namespace fpc
