#include "papers/fopdt_identification.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kLost = 1e-9;  // of the largest b: a sum below is rounding

struct Moments {
  double sum{}, centroid{};
  bool usable{false};
};

Moments momentsOf(double a, VectorRef b) {
  Moments m;
  if (!(a > 0.0 && a < 1.0) || !b.allFinite() || b.size() == 0) return m;
  m.sum = b.sum();
  if (!(std::abs(m.sum) > kLost * b.cwiseAbs().maxCoeff())) return m;
  for (Eigen::Index r = 0; r < b.size(); ++r) m.centroid += static_cast<double>(r + 1) * b[r];
  m.centroid /= m.sum;
  m.usable = m.centroid >= 1.0 - 1e-6 && m.centroid <= static_cast<double>(b.size());
  return m;
}

/// B of (1 - q/z) out of a numerator that holds it as a factor, and what is left over.
double deflate(Vector& b, double q) {
  for (Eigen::Index r = 1; r < b.size(); ++r) b[r] += q * b[r - 1];
  const double remainder = std::abs(b[b.size() - 1]);
  b[b.size() - 1] = 0.0;
  return remainder;
}

int countOf(int n_u, const MisoParams& params) {
  return n_u + n_u * params.numerator_terms + (params.bias ? 1 : 0);
}

}  // namespace

std::optional<Fopdt> recoverFopdt(double a, VectorRef b, double sample_time_min) {
  const Moments m = momentsOf(a, b);
  if (!m.usable) return std::nullopt;
  const double late = std::max(0.0, m.centroid - 1.0), whole = std::floor(late), w = late - whole;
  const double f = 1.0 - std::log(a + w * (1.0 - a)) / std::log(a);
  return Fopdt{m.sum / (1.0 - a), -sample_time_min / std::log(a), (whole + f) * sample_time_min};
}

std::optional<Fopdt> recoverFopdtRounded(double a, VectorRef b, double sample_time_min) {
  const Moments m = momentsOf(a, b);
  if (!m.usable) return std::nullopt;
  const double whole = std::floor(m.centroid - 1.0 + 0.5);
  return Fopdt{m.sum / (1.0 - a), -sample_time_min / std::log(a), whole * sample_time_min};
}

void MisoParams::validate(int n_u) const {
  require(n_u == 1 || n_u == 2, "inputs", "one or two");
  require(numerator_terms >= n_u && numerator_terms <= 1000, "numerator_terms",
          "an integer >= the number of inputs");
  require(method == MisoMethod::kArx || n_u == 1, "method", "arx for more than one input");
  require(warm_up_steps >= 0, "warm_up_steps", "an integer >= 0");
  require(quiet_steps >= 0, "quiet_steps", "an integer >= 0");
  rls.validate();
}

MisoEstimator::MisoEstimator(int n_u, double sample_time_min, const MisoParams& params)
    : n_u_((params.validate(n_u), n_u)),
      sample_time_min_(sample_time_min),
      params_(params),
      rls_(Vector::Zero(countOf(n_u, params)), params.rls),
      regressor_(Vector::Zero(countOf(n_u, params))),
      previous_(Vector::Zero(n_u)) {
  require(std::isfinite(sample_time_min) && sample_time_min > 0.0, "sample_time_min", "a time > 0");
  if (params.bias) regressor_[regressor_.size() - 1] = 1.0;
}

bool MisoEstimator::moved(VectorRef input) {
  still_ = input == previous_ ? still_ + 1 : 0;
  previous_ = input;
  return params_.quiet_steps == 0 || still_ < params_.quiet_steps;
}

// A value that is not finite is taken as the one before it; nothing is learned while it is
// remembered.
void MisoEstimator::remember(VectorRef input) {
  const int m = params_.numerator_terms;
  for (int j = 0; j < n_u_; ++j) {
    auto past = regressor_.segment(n_u_ + j * m, m);
    for (int r = m - 1; r > 0; --r) past[r] = past[r - 1];
    if (std::isfinite(input[j]))
      past[0] = input[j];
    else
      unknown_ = m;
  }
}

bool MisoEstimator::update(VectorRef input, double y) {
  require(input.size() == n_u_, "input", "one value for each input");
  remember(input);
  const bool lively = moved(input);
  bool learned = false;
  const bool known = std::isfinite(y);
  const bool own = params_.method == MisoMethod::kOutputError && samples_ >= params_.warm_up_steps;
  if (samples_ >= n_u_ && lively && known && unknown_ == 0) learned = rls_.update(regressor_, y);
  unknown_ = std::max(unknown_ - 1, known || own ? 0 : n_u_);
  model_output_ = own || !known ? regressor_.dot(rls_.theta()) : y;  // after learning: a posteriori
  for (int i = n_u_ - 1; i > 0; --i) regressor_[i] = regressor_[i - 1];
  regressor_[0] = model_output_;
  ++samples_;
  return learned;
}

Vector MisoEstimator::numerator(int input) const {
  return rls_.theta().segment(n_u_ + input * params_.numerator_terms, params_.numerator_terms);
}

std::optional<Fopdt> MisoEstimator::element(int input) const {
  const Vector& theta = rls_.theta();
  if (n_u_ == 1) return recoverFopdt(theta[0], numerator(0), sample_time_min_);
  // A = 1 - t0/z - t1/z^2 = (1 - p/z)(1 - q/z)
  const double half = 0.5 * theta[0], root = half * half + theta[1];
  if (!(root >= 0.0)) return std::nullopt;
  const std::array<double, 2> poles{half + std::sqrt(root), half - std::sqrt(root)};
  std::array<double, 2> remainder{};  // of both assignments of poles to inputs
  std::array<Vector, 2> own{numerator(0), numerator(1)};
  for (std::size_t first = 0; first < 2; ++first) {
    Vector b0 = numerator(0), b1 = numerator(1);
    remainder[first] =
        deflate(b0, poles[1 - first]) / own[0].norm() + deflate(b1, poles[first]) / own[1].norm();
  }
  const std::size_t first = remainder[0] <= remainder[1] ? 0 : 1;
  const std::size_t mine = input == 0 ? first : 1 - first;
  Vector b = numerator(input);
  deflate(b, poles[1 - mine]);
  return recoverFopdt(poles[mine], b, sample_time_min_);
}

double MisoEstimator::gain(int input) const {
  return numerator(input).sum() / (1.0 - rls_.theta().head(n_u_).sum());
}

// Gradient of B(1) / A(1): K / A(1) to each a, 1 / A(1) to each own b.
}  // namespace fpc
