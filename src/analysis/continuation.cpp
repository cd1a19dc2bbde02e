#include "analysis/continuation.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/curve.hpp"
#include "analysis/steady_state.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kGrowth = 1.3;
constexpr double kSameState = 1e-5;  // in sizes
constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};

double halton(int index, Eigen::Index dimension) {
  const int base = kPrimes[static_cast<std::size_t>(dimension) % std::size(kPrimes)];
  double value = 0.0, part = 1.0;
  for (; index > 0; index /= base) {
    part /= base;
    value += part * (index % base);
  }
  return value;
}

class Tracer {
 public:
  Tracer(const ContinuationProblem& problem, const ContinuationParams& params)
      : problem_(problem), params_(params), curve_(problem, params) {}

  std::vector<TracedPoint> scan(double parameter) const;
  bool known(const TracedPoint& point) const;
  void trace(const TracedPoint& start);
  std::vector<Branch> branches_;

 private:
  Vector start(int i) const;
  bool inside(const TracedPoint& point) const;
  bool follow(const TracedPoint& start, double direction, Branch& branch) const;
  bool back(const TracedPoint& start, const TracedPoint& now) const;
  TracedPoint lastInside(const TracedPoint& from, double step) const;

  const ContinuationProblem& problem_;
  const ContinuationParams& params_;
  Curve curve_;
};

Vector Tracer::start(int i) const {
  if (i < params_.starts.cols()) return params_.starts.col(i);
  const int index = i - static_cast<int>(params_.starts.cols()) + 1;
  Vector x(curve_.size());
  for (Eigen::Index j = 0; j < x.size(); ++j)
    x[j] = params_.state_lower[j] +
           halton(index, j) * (params_.state_upper[j] - params_.state_lower[j]);
  return x;
}

/// All steady states at one parameter value that the starts lead to.
std::vector<TracedPoint> Tracer::scan(double parameter) const {
  const Derivative f = [&](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> value) {
    problem_.field(x, parameter, value);
  };
  std::vector<TracedPoint> found;
  const int n = static_cast<int>(params_.starts.cols()) + params_.scanned_starts;
  for (int i = 0; i < n; ++i) {
    const SteadyState steady = findSteadyState(f, start(i), Vector(), Vector());
    TracedPoint point;
    if (!steady.ok() ||
        !curve_.pointAt(steady.x, parameter, Vector::Unit(curve_.size() + 1, curve_.size()), point))
      continue;
    if (!inside(point)) continue;
    const bool twice = std::any_of(found.begin(), found.end(), [&](const TracedPoint& other) {
      return (other.z - point.z).norm() < kSameState;
    });
    if (!twice) found.push_back(point);
  }
  return found;
}

bool Tracer::inside(const TracedPoint& point) const {
  const double tiny = 1e-9 * (params_.upper - params_.lower);
  const Vector span = params_.state_upper - params_.state_lower;
  return point.at.parameter >= params_.lower - tiny && point.at.parameter <= params_.upper + tiny &&
         (point.at.state.array() >= (params_.state_lower - span).array()).all() &&
         (point.at.state.array() <= (params_.state_upper + span).array()).all();
}

/// Whether a branch passes through the point: projected on the nearest stretch of every branch.
bool Tracer::known(const TracedPoint& point) const {
  for (const auto& branch : branches_)
    for (std::size_t i = 0; i + 1 < branch.points.size(); ++i) {
      const auto& a = branch.points[i];
      const auto& b = branch.points[i + 1];
      const Vector za = curve_.scaled(a.state, a.parameter);
      const Vector along = curve_.scaled(b.state, b.parameter) - za;
      const double t =
          std::clamp(along.dot(point.z - za) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
      if ((point.z - za - t * along).norm() < 0.1 * along.norm() + kSameState) return true;
    }
  return false;
}

bool Tracer::back(const TracedPoint& start, const TracedPoint& now) const {
  return (start.z - now.z).norm() < 0.7 * params_.step_max && now.tangent.dot(start.tangent) > 0.9;
}

/// The end of a branch at the border of the parameter's range.
TracedPoint Tracer::lastInside(const TracedPoint& from, double step) const {
  TracedPoint last = from;
  double low = 0.0, high = step;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    TracedPoint point;
    if (!curve_.step(from, middle, point)) break;
    if (inside(point)) {
      last = point;
      low = middle;
    } else {
      high = middle;
    }
  }
  return last;
}

/// Appends the points that follow `start`; true if the branch came back to it.
bool Tracer::follow(const TracedPoint& start, double direction, Branch& branch) const {
  TracedPoint now = start;
  double step = 0.2 * params_.step_max;
  double travelled = 0.0;
  while (static_cast<int>(branch.points.size()) < params_.max_points) {
    TracedPoint next;
    if (!curve_.step(now, direction * step, next)) {
      step *= 0.5;
      if (step < params_.step_min) return false;
      continue;
    }
    const bool leaves = !inside(next);
    if (leaves) next = lastInside(now, direction * step);
    const double length = now.tangent.dot(next.z - now.z);
    findSpecialPoints(curve_, now, length, next, problem_.map, branch.special);
    branch.points.push_back(next.at);
    if (leaves) return false;
    travelled += step;
    if (travelled > 4.0 * params_.step_max && back(start, next)) {
      const double rest = next.tangent.dot(start.z - next.z);
      findSpecialPoints(curve_, next, rest, start, problem_.map, branch.special);
      branch.points.push_back(start.at);
      return true;
    }
    now = next;
    step = std::min(params_.step_max, step * kGrowth);
  }
  return false;
}

void Tracer::trace(const TracedPoint& start) {
  Branch branch, backwards;
  branch.closed = follow(start, 1.0, branch);
  if (!branch.closed) follow(start, -1.0, backwards);
  Branch whole;
  whole.closed = branch.closed;
  whole.points.assign(backwards.points.rbegin(), backwards.points.rend());
  whole.points.push_back(start.at);
  whole.points.insert(whole.points.end(), branch.points.begin(), branch.points.end());
  whole.special.assign(backwards.special.rbegin(), backwards.special.rend());
  whole.special.insert(whole.special.end(), branch.special.begin(), branch.special.end());
  branches_.push_back(whole);
}

}  // namespace

void ContinuationParams::validate(Eigen::Index n_x) const {
  require(std::isfinite(lower) && std::isfinite(upper) && lower < upper, "lower, upper",
          "finite numbers, the lower one first");
  require(state_size.size() == n_x && (state_size.array() > 0.0).all(), "state_size",
          "one number > 0 per state");
  require(state_lower.size() == n_x && state_upper.size() == n_x && state_lower.allFinite() &&
              state_upper.allFinite(),
          "state_lower, state_upper", "one finite number per state");
  require(starts.size() == 0 || starts.rows() == n_x, "starts", "one column of states per start");
  require(scanned_starts >= 0 && scanned_parameters >= 1, "scanned_starts, scanned_parameters",
          "counts");
  require(step_min > 0.0 && step_max > step_min, "step_max", "a number > step_min > 0");
  require(max_points >= 2, "max_points", "an integer >= 2");
}

std::vector<Branch> continueBranches(const ContinuationProblem& problem,
                                     const ContinuationParams& params,
                                     const std::function<void(int branches)>& progress) {
  params.validate(params.state_size.size());
  Tracer tracer(problem, params);
  const int n = params.scanned_parameters;
  for (int i = 0; i < n; ++i) {
    const double part = n == 1 ? 0.5 : static_cast<double>(i) / (n - 1);
    for (const auto& point : tracer.scan(params.lower + part * (params.upper - params.lower)))
      if (!tracer.known(point)) {
        tracer.trace(point);
        if (progress) progress(static_cast<int>(tracer.branches_.size()));
      }
  }
  return tracer.branches_;
}

std::vector<BranchPoint> steadyStatesAt(const ContinuationProblem& problem,
                                        const ContinuationParams& params, double parameter) {
  params.validate(params.state_size.size());
  std::vector<BranchPoint> points;
  for (const auto& point : Tracer(problem, params).scan(parameter)) points.push_back(point.at);
  return points;
}

}  // namespace fpc
