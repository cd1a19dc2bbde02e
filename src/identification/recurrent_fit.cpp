#include "identification/recurrent_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthestFitState =
    30.0;  // deviations of the data: a run that leaves further has failed
constexpr double kMostFitDamping = 1e8;
constexpr double kPerRow = 40.0, kPerSet = 12.0;  // multiply-adds of a step, of a set in it

/// Error of a prediction and its derivative to x1. A limit reached by both is no error; a limit
/// reached by one is judged before clipping, so that the fit still feels it.
struct Miss {
  double error{}, slope{1.0};
};
Miss missOf(const RecurrentShape& shape, double measured, double x1) {
  Miss miss;
  double y = x1;
  if (shape.absolute) {
    y = std::abs(x1);
    miss.slope = x1 < 0.0 ? -1.0 : 1.0;
  }
  miss.error = measured - y;
  if (shape.lower < shape.upper && ((measured >= shape.upper && y >= shape.upper) ||
                                    (measured <= shape.lower && y <= shape.lower)))
    miss = {0.0, 0.0};
  return miss;
}

/// Sums of squares, their gradient and Gauss-Newton matrix.
struct Normal {
  Matrix hessian;
  Vector gradient;
  double sum{};
};

/// Rows of a Jacobian and their errors on the way into normal equations: many at once, which is
/// several times faster than one by one. The last row of `sum_` collects the gradient.
class NormalRows {
 public:
  explicit NormalRows(Index unknowns)
      : rows_(unknowns + 1, kPanel), sum_(Matrix::Zero(unknowns + 1, unknowns + 1)) {}

  void add(const Eigen::Ref<const Vector>& row, double error, double weight) {
    const double root = std::sqrt(weight);
    rows_.col(count_).head(row.size()) = root * row;
    rows_(row.size(), count_) = root * error;
    if (++count_ == kPanel) flush();
  }

  /// The first `shared` unknowns stand first in `normal`, the others from `own` on.
  void addTo(Normal& normal, Index shared, Index own) {
    flush();
    const Index rest = sum_.rows() - 1 - shared;
    normal.hessian.topLeftCorner(shared, shared) += sum_.topLeftCorner(shared, shared);
    normal.gradient.head(shared) += sum_.row(shared + rest).head(shared).transpose();
    if (rest == 0) return;
    normal.hessian.block(own, 0, rest, shared) += sum_.block(shared, 0, rest, shared);
    normal.hessian.block(own, own, rest, rest) += sum_.block(shared, shared, rest, rest);
    normal.gradient.segment(own, rest) += sum_.row(shared + rest).segment(shared, rest).transpose();
  }

 private:
  static constexpr Index kPanel = 64;

  void flush() {
    if (count_ > 0) sum_.selfadjointView<Eigen::Lower>().rankUpdate(rows_.leftCols(count_));
    count_ = 0;
  }

  Matrix rows_, sum_;
  Index count_{};
};

class Objective {
 public:
  Objective(const RecurrentShape& shape, const RecurrentData& data,
            const std::vector<Stretch>& stretches, const Vector& anchor, const Vector& start,
            const RecurrentFitParams& params)
      : shape_(shape), data_(data), stretches_(stretches), params_(params), step_(shape) {
    const Index n_theta = shape.parameterCount();
    n_starts_ = shape.companion ? 0 : shape.states;
    unknowns_ = n_theta + n_starts_ * static_cast<Index>(stretches.size());
    target_ = Vector::Zero(unknowns_);
    target_.head(shape.linearCount()) = anchor.head(shape.linearCount());
    target_.segment(shape.linearCount(), 2 * shape.setCount()) = start.tail(2 * shape.setCount());
    pull_ = Vector::Constant(unknowns_, params.start_ridge);
    pull_.head(shape.linearCount()).setConstant(params.ridge);
    pull_.segment(shape.linearCount(), 2 * shape.setCount()).setConstant(params.set_ridge);
    for (std::size_t s = 0; n_starts_ > 0 && s < stretches.size(); ++s) {
      const double y = data.y[stretches[s].first];
      target_[startAt(s)] = std::isfinite(y) ? y : 0.0;
    }
  }

  Index unknowns() const { return unknowns_; }
  Index startAt(std::size_t s) const {
    return shape_.parameterCount() + static_cast<Index>(s) * n_starts_;
  }
  Vector begin(const Vector& start) const {
    Vector all = target_;
    all.head(shape_.parameterCount()) = start;
    return all;
  }

  /// Multiply-adds of all calls so far, about.
  double work() const { return work_; }

  double operator()(const Vector& p, Normal* normal) {
    double sum = (pull_.array() * (p - target_).array().square()).sum();
    if (normal != nullptr) {
      normal->hessian = Matrix::Zero(unknowns_, unknowns_);
      normal->hessian.diagonal() = pull_;
      normal->gradient = pull_.cwiseProduct(target_ - p);
    }
    for (std::size_t s = 0; s < stretches_.size() && std::isfinite(sum); ++s)
      sum += free(p, s, normal);
    if (shape_.companion && params_.one_step_weight > 0.0 && std::isfinite(sum))
      for (const auto& stretch : stretches_) sum += oneStep(p, stretch, normal);
    return sum;
  }

 private:
  bool past(Index k, Vector& x) const {
    for (Index j = 0; j < shape_.states; ++j) {
      if (k - j < 0 || !std::isfinite(data_.y[k - j])) return false;
      x[j] = data_.y[k - j];
    }
    return true;
  }

  void count(Index rows, bool derived) {
    const auto n = static_cast<double>(shape_.states),
               unknowns = static_cast<double>(shape_.parameterCount() + n_starts_);
    const double step = kPerRow + static_cast<double>(shape_.linearCount()) +
                        kPerSet * static_cast<double>(shape_.setCount());
    const double derivative = n * n * unknowns + 0.5 * unknowns * unknowns + 2.0 * step;
    work_ += static_cast<double>(rows) * (step + (derived ? derivative : 0.0));
  }
  double free(const Vector& p, std::size_t s, Normal* normal);
  double oneStep(const Vector& p, const Stretch& stretch, Normal* normal);

  const RecurrentShape& shape_;
  const RecurrentData& data_;
  const std::vector<Stretch>& stretches_;
  const RecurrentFitParams& params_;
  RecurrentStep step_;
  Vector target_, pull_;
  Index unknowns_{}, n_starts_{};
  double work_{};
};

double Objective::free(const Vector& p, std::size_t s, Normal* normal) {
  const Index n = shape_.states, n_theta = shape_.parameterCount();
  const double weight = 1.0 / (params_.free_unit * params_.free_unit);
  Vector x = Vector::Zero(n), next(n);
  Matrix sensitivity = Matrix::Zero(n, n_theta + n_starts_);
  Vector row(n_theta + n_starts_);
  NormalRows rows(normal != nullptr ? n_theta + n_starts_ : 0);
  bool started = n_starts_ > 0;
  if (started) {
    x = p.segment(startAt(s), n);
    sensitivity.rightCols(n).setIdentity();
  }
  double sum = 0.0;
  const auto judge = [&](Index k) {
    if (!std::isfinite(data_.y[k])) return;
    const Miss miss = missOf(shape_, data_.y[k], x[0]);
    sum += weight * miss.error * miss.error;
    if (normal == nullptr || miss.slope == 0.0) return;
    row = miss.slope * sensitivity.row(0).transpose();
    rows.add(row, miss.error, weight);
  };
  if (started) judge(stretches_[s].first);
  const auto theta = p.head(n_theta);
  count(stretches_[s].last - stretches_[s].first, normal != nullptr);
  for (Index k = stretches_[s].first; k + 1 < stretches_[s].last; ++k) {
    if (!data_.v.col(k).allFinite()) {
      started = n_starts_ > 0;  // a hidden state stays where it is over a gap
      continue;
    }
    if (!started) {
      if (k - stretches_[s].first + 1 < n || !past(k, x)) continue;
      sensitivity.setZero();
      started = true;
    }
    step_.predict(theta, x, data_.v.col(k), next);
    if (normal != nullptr) step_.differentiate(theta, sensitivity);
    x = next;
    if (!(x.cwiseAbs().maxCoeff() < kFarthestFitState)) return kInfinity;
    judge(k + 1);
  }
  if (normal != nullptr) rows.addTo(*normal, n_theta, startAt(s));
  return sum;
}

double Objective::oneStep(const Vector& p, const Stretch& stretch, Normal* normal) {
  const double weight = params_.one_step_weight / (params_.step_unit * params_.step_unit);
  Vector x(shape_.states), next(shape_.states), row(shape_.parameterCount());
  const auto theta = p.head(shape_.parameterCount());
  NormalRows rows(normal != nullptr ? row.size() : 0);
  double sum = 0.0;
  count(stretch.last - stretch.first, normal != nullptr);
  for (Index k = stretch.first + shape_.states - 1; k + 1 < stretch.last; ++k) {
    if (!data_.v.col(k).allFinite() || !std::isfinite(data_.y[k + 1]) || !past(k, x)) continue;
    step_.predict(theta, x, data_.v.col(k), next);
    const Miss miss = missOf(shape_, data_.y[k + 1], next[0]);
    sum += weight * miss.error * miss.error;
    if (normal == nullptr || miss.slope == 0.0) continue;
    step_.direct(theta, row);
    row *= miss.slope;
    rows.add(row, miss.error, weight);
  }
  if (normal != nullptr) rows.addTo(*normal, row.size(), 0);
  return sum;
}

/// Moves the start to where prior knowledge admits it; its objective there.
double admitted(Objective& objective, const RecurrentFitParams& params, double value, Vector& p,
                Normal& normal) {
  Matrix metric = Matrix::Identity(p.size(), p.size());
  if (std::isfinite(value)) {
    metric = normal.hessian.selfadjointView<Eigen::Lower>();
    metric.diagonal() += 1e-6 * metric.diagonal() + Vector::Constant(p.size(), 1e-9);
  }
  if (!params.admit(metric, p)) return kInfinity;
  return objective(p, &normal);
}

}  // namespace

RecurrentFitResult fitRecurrent(const RecurrentShape& shape, const RecurrentData& data,
                                const std::vector<Stretch>& stretches, const Vector& anchor,
                                const Vector& start, const RecurrentFitParams& params,
                                const std::function<bool(const Vector&)>& proceed) {
  Objective objective(shape, data, stretches, anchor, start, params);
  Vector p = objective.begin(start), trial;
  Normal normal;
  RecurrentFitResult result;
  double best = objective(p, &normal), damping = 1e-2;
  if (params.admit) best = admitted(objective, params, best, p, normal);
  result.finite = std::isfinite(best);
  for (; result.finite && result.iterations < params.iterations; ++result.iterations) {
    bool improved = false, settled = false;
    for (; damping < kMostFitDamping && !improved; damping *= improved ? 1.0 : 6.0) {
      Matrix damped = normal.hessian;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-9;
      trial = p + damped.selfadjointView<Eigen::Lower>().ldlt().solve(normal.gradient);
      if (params.centre_lower.size() == shape.setCount()) {
        auto centres = trial.segment(shape.linearCount(), shape.setCount());
        centres = centres.cwiseMax(params.centre_lower).cwiseMin(params.centre_upper);
      }
      const bool admissible = trial.allFinite() && (!params.admit || params.admit(damped, trial));
      const double reached = admissible ? objective(trial, nullptr) : kInfinity;
      improved = reached < best;
      if (!improved) continue;
      settled = reached > (1.0 - params.settle) * best;
      best = reached;
      p = trial;
    }
    if (!improved || settled) break;
    damping = std::max(damping / 10.0, 1e-9);
    if (proceed && !proceed(p.head(shape.parameterCount()))) break;
    objective(p, &normal);
  }
  result.parameters = p.head(shape.parameterCount());
  result.work = objective.work();
  result.objective = best;
  if (!shape.companion)
    result.starts = Eigen::Map<const Matrix>(p.data() + shape.parameterCount(), shape.states,
                                             static_cast<Index>(stretches.size()));
  return result;
}

}  // namespace fpc
