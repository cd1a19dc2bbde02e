#include "supervision/health/step_response.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr int kOutputs = 20, kInputs = 25;  // past values
constexpr int kSteps = 30, kDraws = 60;
constexpr double kCertain = 4.5;  // standard deviations of a coefficient
constexpr double kFewestRows = 4.0;
constexpr Eigen::Index kMostRows = 20000;
constexpr double kOutdatedDistance = 0.35, kOutdatedCertainty = 2.5, kWideBounds = 0.6;

struct ArxFit {
  Vector theta;          // outputs, inputs, one; empty: no fit
  Eigen::MatrixXd root;  // of the covariance
};

ArxFit fitArx(const std::vector<double>& u, const std::vector<double>& y) {
  std::vector<std::size_t> rows;
  int run = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    run = std::isfinite(y[k]) && std::isfinite(u[k]) ? run + 1 : 0;
    if (run > kInputs) rows.push_back(k);
  }
  const int unknowns = kOutputs + kInputs + 1;
  if (static_cast<double>(rows.size()) < kFewestRows * unknowns) return {};
  if (static_cast<Eigen::Index>(rows.size()) > kMostRows)
    rows.erase(rows.begin(), rows.end() - kMostRows);
  Matrix a(static_cast<Eigen::Index>(rows.size()), unknowns);
  Vector b(a.rows());
  const double mean_y = meanOf(y), mean_u = meanOf(u);
  const double std_y = stdOf(y), std_u = stdOf(u);
  if (!(std_y > 0.0) || !(std_u > 0.0)) return {};
  for (Eigen::Index r = 0; r < a.rows(); ++r) {
    const std::size_t k = rows[static_cast<std::size_t>(r)];
    for (int i = 0; i < kOutputs; ++i)
      a(r, i) = (y[k - static_cast<std::size_t>(i) - 1] - mean_y) / std_y;
    for (int i = 0; i < kInputs; ++i)
      a(r, kOutputs + i) = (u[k - static_cast<std::size_t>(i) - 1] - mean_u) / std_u;
    a(r, unknowns - 1) = 1.0;
    b[r] = (y[k] - mean_y) / std_y;
  }
  Matrix normal = a.transpose() * a;
  const double rows_d = static_cast<double>(a.rows());
  normal.diagonal().array() += 1e-9 * rows_d;
  const Eigen::LDLT<Matrix> solver(normal);
  ArxFit fit;
  fit.theta = solver.solve(a.transpose() * b);
  const double noise = (b - a * fit.theta).squaredNorm() / (rows_d - unknowns);
  const Matrix covariance = noise * solver.solve(Matrix::Identity(unknowns, unknowns));
  Vector scale = Vector::Ones(unknowns);
  scale.segment(kOutputs, kInputs).setConstant(std_y / std_u);
  fit.theta = fit.theta.cwiseProduct(scale);
  const Matrix scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::LLT<Matrix> root(scaled);
  if (root.info() != Eigen::Success || !fit.theta.allFinite()) return {};
  fit.root = root.matrixL();
  return fit;
}

std::vector<double> stepOf(const Vector& theta) {
  std::vector<double> y(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    double value = 0.0;
    for (int i = 0; i < kOutputs && i < k; ++i)
      value += theta[i] * y[static_cast<std::size_t>(k - 1 - i)];
    for (int i = 0; i < kInputs && i <= k; ++i) value += theta[kOutputs + i];
    y[static_cast<std::size_t>(k)] = std::clamp(value, -1e12, 1e12);
  }
  return y;
}

StepResponse responseOf(const ArxFit& fit, double sample_time_s) {
  StepResponse r{sample_time_s, stepOf(fit.theta), std::vector<double>(kSteps, 0.0)};
  std::mt19937_64 engine = seededEngine(1, {});
  for (int draw = 0; draw < kDraws; ++draw) {
    Vector normal(fit.theta.size());
    for (double& v : normal) v = standardNormal(engine);
    const std::vector<double> other = stepOf(fit.theta + fit.root * normal);
    for (std::size_t k = 0; k < other.size(); ++k)
      r.std[k] += (other[k] - r.value[k]) * (other[k] - r.value[k]);
  }
  for (double& s : r.std) s = std::sqrt(s / kDraws);
  return r;
}

/// The first coefficient of the input that is certain; 0: none.
int firstCertain(const ArxFit& fit) {
  for (int i = 0; i < kInputs; ++i) {
    const double std = fit.root.row(kOutputs + i).norm();
    if (std::abs(fit.theta[kOutputs + i]) > kCertain * std) return i + 1;
  }
  return 0;
}

/// The same of a response whose end is certain: where it first shows.
double firstCertain(const StepResponse& r, Eigen::Index factor) {
  const double end = std::abs(r.value.back());
  if (!(r.std.back() < 0.4 * end)) return kNaN;
  for (std::size_t k = 0; k < r.value.size(); ++k)
    if (std::abs(r.value[k]) > std::max(3.0 * r.std[k], 0.03 * end))
      return 1.0 + static_cast<double>(k) * static_cast<double>(factor);
  return kNaN;
}

double between(const std::vector<double>& values, double at) {
  // values[i] at i + 1, 0 at 0
  if (at <= 0.0) return 0.0;
  const auto below = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(below);
  if (below > values.size() || (below == values.size() && part > 1e-9)) return kNaN;
  const double low = below == 0 ? 0.0 : values[below - 1];
  return part <= 1e-9 ? low : low + part * (values[below] - low);
}

}  // namespace

double StepResponse::at(double time_s) const { return between(value, time_s / sample_time_s); }
double StepResponse::stdAt(double time_s) const {
  return std.empty() ? 0.0 : between(std, time_s / sample_time_s);
}

ReactionCurve reactionCurve(const StepResponse& r) {
  ReactionCurve curve;
  if (r.value.size() < 3) return curve;
  const double end = r.value.back();
  if (end == 0.0 || (!r.std.empty() && !(r.std.back() < 0.4 * std::abs(end)))) return curve;
  double steepest = 0.0, at = 0.0, height = 0.0, before = 0.0;
  for (std::size_t k = 0; k < r.value.size(); ++k) {
    const double value = r.value[k] / end, rise = value - before;
    if (rise > steepest) {
      steepest = rise;
      at = static_cast<double>(k) + 0.5;
      height = 0.5 * (value + before);
    }
    before = value;
  }
  if (!(steepest > 0.0)) return curve;
  curve.dead_time_s = std::max(0.5, at - height / steepest) * r.sample_time_s;
  curve.time_constant_s = r.sample_time_s / steepest;
  return curve;
}

LoopDynamics loopDynamics(const std::vector<double>& u, const std::vector<double>& y,
                          Eigen::Index factor, double sample_time_s) {
  LoopDynamics found;
  const ArxFit fit = fitArx(blockMeans(u, factor), blockMeans(y, factor));
  if (fit.theta.size() == 0) return found;
  found.response = responseOf(fit, sample_time_s * static_cast<double>(factor));
  for (Eigen::Index finer = 1; finer <= factor; finer *= 2) {
    const ArxFit f = finer == factor ? fit : fitArx(blockMeans(u, finer), blockMeans(y, finer));
    if (f.theta.size() == 0) continue;
    const int first = firstCertain(f);
    if (first > 0) {
      found.delay = 1.0 + static_cast<double>((first - 1) * finer);
      break;
    }
  }
  if (!std::isfinite(found.delay)) found.delay = firstCertain(found.response, factor);
  return found;
}

ModelAge compareModel(const StepResponse& model, const StepResponse& record) {
  ModelAge age;
  double difference = 0.0, size = 0.0, own = 0.0, bounds = 0.0, squares = 0.0, count = 0.0,
         last = 0.0;
  for (std::size_t k = 0; k < record.value.size(); ++k) {
    const double t = record.sample_time_s * static_cast<double>(k + 1), m = model.at(t);
    if (!std::isfinite(m)) break;
    const double d = record.value[k] - m, s = record.stdAt(t);
    difference += d * d;
    size += m * m;
    own += record.value[k] * record.value[k];
    bounds += s * s;
    if (s > 0.0) squares += d * d / (s * s);
    count += 1.0;
    last = m;
    if (last != 0.0) age.gain_ratio = record.value[k] / last;
  }
  if (count < 3.0 || !(size > 0.0)) return age;
  age.judged = std::sqrt(bounds / std::max(size, std::min(own, 25.0 * size))) < kWideBounds;
  age.distance = std::sqrt(difference / size);
  age.certainty = std::sqrt(squares / count);
  age.outdated =
      age.judged && age.distance > kOutdatedDistance && age.certainty > kOutdatedCertainty;
  return age;
}

}  // namespace fpc
