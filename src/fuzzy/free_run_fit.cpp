#include "fmbpc/fuzzy/free_run_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fuzzy/free_run_simulator.hpp"
#include "fuzzy/knowledge_map.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kEnough = 1e-6;  // relative fall of the objective below which the fit has settled
constexpr double kFirstDamping = 1e-3;  // of the number of rows
constexpr double kMostDamping = 1e6;

/// The objective and its Gauss-Newton steps.
class Fit {
 public:
  using Admit = std::function<bool(const Matrix& metric, Vector& theta)>;

  Fit(FreeRunSimulator& simulator, const ConsequentParams& params, const Vector& linear,
      Admit admit)
      : simulator_(simulator), params_(params), linear_(linear), admit_(std::move(admit)) {
    const double free = simulator.run(linear, true, 1.0, 1.0, nullptr);
    const double rows = static_cast<double>(std::max<Index>(simulator.rows(), 1));
    free_unit_ = unitOf(free, rows);
    step_unit_ = unitOf(simulator.run(linear, false, 1.0, 1.0, nullptr), rows);
  }

  double objective(const Vector& theta) {
    const double free = simulator_.run(theta, true, 1.0, 1.0, nullptr) / (free_unit_ * free_unit_);
    if (!std::isfinite(free)) return free;
    double sum = free + pull() * (theta - linear_).squaredNorm();
    if (params_.one_step_weight > 0.0)
      sum += params_.one_step_weight * simulator_.run(theta, false, 1.0, 1.0, nullptr) /
             (step_unit_ * step_unit_);
    return sum;
  }

  LeastSquares linearise(const Vector& theta) {
    LeastSquares squares(simulator_.unknowns());
    simulator_.run(theta, true, free_unit_, 1.0, &squares);
    if (params_.one_step_weight > 0.0)
      simulator_.run(theta, false, step_unit_, params_.one_step_weight, &squares);
    Vector row = Vector::Zero(simulator_.unknowns());
    for (Index i = 0; i < row.size(); ++i) {
      row[i] = 1.0;
      squares.add(row, linear_[i] - theta[i], pull());
      row[i] = 0.0;
    }
    return squares;
  }

  /// One damped step that lowers the objective. @return false if there is none.
  bool improve(Vector& theta, double& best) {
    LeastSquares squares = linearise(theta);
    const double rows = static_cast<double>(squares.rows());
    for (; damping_ < kMostDamping; damping_ *= 8.0) {
      Vector next = theta + squares.solve(damping_ * rows).theta;
      if (admit_ && !admit_(squares.metric(), next)) continue;
      const double reached = objective(next);
      if (!(reached < best)) continue;
      const bool settled = reached > (1.0 - kEnough) * best;
      theta = next;
      best = reached;
      damping_ = std::max(damping_ / 8.0, 1e-12);
      return !settled;
    }
    return false;
  }

 private:
  static double unitOf(double sum, double rows) {
    const double rms = std::sqrt(sum / rows);
    return std::isfinite(rms) && rms > 0.0 ? rms : 1.0;
  }

  /// The ridge in the units of the objective.
  double pull() const { return params_.ridge / (step_unit_ * step_unit_); }

  FreeRunSimulator& simulator_;
  const ConsequentParams& params_;
  Vector linear_;
  Admit admit_;
  double free_unit_{1.0}, step_unit_{1.0}, damping_{kFirstDamping};
};

/// Moves coefficients to the nearest that agree with what is known; empty if nothing is.
Fit::Admit admission(const DataSet& data, int output, const OutputModel& model,
                     const FreeRunSimulator& simulator, const PriorKnowledge& known) {
  if (known.empty()) return {};
  const auto consequents = [&simulator, own = model](const Vector& theta) mutable {
    simulator.write(theta, own.rules);
    return stackedConsequents(own.rules);
  };
  const KnowledgeRows rows =
      inParameters(knowledgeRows(model, output, data, known), simulator.unknowns(), consequents);
  return
      [&simulator, &known, rows, own = model, output](const Matrix& metric, Vector& theta) mutable {
        const double little = 1e-9 * metric.trace() + 1e-300;
        const Matrix H = metric + little * Matrix::Identity(metric.rows(), metric.cols());
        if (!nearestInside(rows, H, theta)) return false;
        simulator.write(theta, own.rules);
        return keepsPoles(own, output, known);
      };
}

}  // namespace

FreeRunFit fitFreeRun(const DataSet& data, int output, const OutputModel& linear,
                      const ConsequentParams& params, OutputModel& model,
                      const std::function<bool()>& proceed, const PriorKnowledge& known) {
  FreeRunSimulator simulator(data, output, model);
  const std::vector<Rule> same(model.rules.size(), linear.rules.front());
  const Vector start = simulator.scaled(same);
  Fit fit(simulator, params, start, admission(data, output, model, simulator, known));
  const auto rms = [&](const Vector& theta) {
    const double sum = simulator.run(theta, true, 1.0, 1.0, nullptr);
    return std::sqrt(sum / static_cast<double>(std::max<Index>(simulator.rows(), 1)));
  };
  FreeRunFit result;
  Vector theta = simulator.scaled(model.rules);
  result.before = rms(theta);
  double best = fit.objective(theta);
  const double best_linear = fit.objective(start);
  if (best_linear < best) {
    theta = start;
    best = best_linear;
  }
  if (!std::isfinite(best)) return result;
  bool going = true;
  while (going && result.iterations < params.free_run_iterations) {
    result.cancelled = proceed && !proceed();
    if (result.cancelled) return result;
    going = fit.improve(theta, best);
    ++result.iterations;
  }
  result.after = rms(theta);
  simulator.write(theta, model.rules);
  return result;
}

}  // namespace fpc
