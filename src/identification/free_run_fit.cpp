#include "identification/free_run_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/free_run_simulator.hpp"
#include "identification/knowledge_map.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kEnough = 1e-6;  // relative fall of the objective below which the fit has settled
constexpr double kFirstDamping = 1e-3;  // of the number of rows
constexpr double kMostDamping = 1e6;

/// What a vector of coefficients reaches.
struct FreeRunPoint {
  double objective{}, rms{};  // rms: of the free run
};

/// The objective and its Gauss-Newton steps.
class Fit {
 public:
  using Admit = std::function<bool(const Matrix& metric, Vector& theta)>;

  Fit(FreeRunSimulator& simulator, const ConsequentParams& params, const Vector& linear,
      Admit admit)
      : simulator_(simulator), params_(params), linear_(linear), admit_(std::move(admit)) {
    linear_sums_ = runFree(linear);
    linear_sums_.step = simulator.run(linear, false, 1.0, 1.0, nullptr);
    const double rows = static_cast<double>(linear_sums_.rows);
    free_unit_ = unitOf(linear_sums_.free, rows);
    step_unit_ = unitOf(linear_sums_.step, rows);
  }

  FreeRunPoint at(const Vector& theta) {
    Sums sums = runFree(theta);
    if (params_.one_step_weight > 0.0 && std::isfinite(sums.free))
      sums.step = simulator_.run(theta, false, 1.0, 1.0, nullptr);
    return pointOf(theta, sums);
  }

  /// Of the linear model, whose runs are known.
  FreeRunPoint atLinear() const { return pointOf(linear_, linear_sums_); }

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
  bool improve(Vector& theta, FreeRunPoint& best) {
    LeastSquares squares = linearise(theta);
    const double rows = static_cast<double>(squares.rows());
    for (; damping_ < kMostDamping; damping_ *= 8.0) {
      Vector next = theta + squares.solve(damping_ * rows).theta;
      if (admit_ && !admit_(squares.metric(), next)) continue;
      const FreeRunPoint reached = at(next);
      if (!(reached.objective < best.objective)) continue;
      const bool settled = reached.objective > (1.0 - kEnough) * best.objective;
      theta = next;
      best = reached;
      damping_ = std::max(damping_ / 8.0, 1e-12);
      return !settled;
    }
    return false;
  }

 private:
  /// Sums of squared errors, and the rows of the free run.
  struct Sums {
    double free{}, step{};
    Index rows{};
  };

  Sums runFree(const Vector& theta) {
    const double free = simulator_.run(theta, true, 1.0, 1.0, nullptr);
    return {free, 0.0, std::max<Index>(simulator_.rows(), 1)};
  }

  FreeRunPoint pointOf(const Vector& theta, const Sums& sums) const {
    double objective = sums.free / (free_unit_ * free_unit_);
    if (std::isfinite(objective)) {
      objective += pull() * (theta - linear_).squaredNorm();
      if (params_.one_step_weight > 0.0)
        objective += params_.one_step_weight * sums.step / (step_unit_ * step_unit_);
    }
    return {objective, std::sqrt(sums.free / static_cast<double>(sums.rows))};
  }

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
  Sums linear_sums_;
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
  FreeRunFit result;
  Vector theta = simulator.scaled(model.rules);
  FreeRunPoint best = fit.at(theta);
  result.before = best.rms;
  if (fit.atLinear().objective < best.objective) {
    theta = start;
    best = fit.atLinear();
  }
  if (!std::isfinite(best.objective)) return result;
  bool going = true;
  while (going && result.iterations < params.free_run_iterations) {
    result.cancelled = proceed && !proceed();
    if (result.cancelled) return result;
    going = fit.improve(theta, best);
    ++result.iterations;
  }
  result.after = best.rms;
  simulator.write(theta, model.rules);
  return result;
}

}  // namespace fpc
