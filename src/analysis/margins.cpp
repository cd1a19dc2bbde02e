#include "analysis/margins.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr int kPerDecade = 200;  // frequencies
constexpr int kSignHalvings = 60;

double swing(const Matrix& response, Index from, Index count) {
  return response.middleCols(from, count).cwiseAbs().maxCoeff();
}

/// Where the value changes its sign between two frequencies.
template <typename Function>
double signChange(double low, double high, Function value) {
  const bool above = value(low) > 0.0;
  for (int i = 0; i < kSignHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((value(middle) > 0.0) == above ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

PulseResponse::PulseResponse(std::vector<Matrix> reached, double sample_time_s)
    : reached_(std::move(reached)), sample_time_(sample_time_s) {
  require(!reached_.empty() && reached_.front().cols() >= 10, "pulse response",
          "one for each input, of 10 samples at least");
  for (const Matrix& response : reached_)
    require(response.rows() == static_cast<Index>(reached_.size()) &&
                response.cols() == reached_.front().cols(),
            "pulse response", "n_u rows and the same number of samples each");
  const double highest = kHalfTurn / sample_time_;
  const double lowest = 2.0 * highest / static_cast<double>(reached_.front().cols());
  const int count =
      std::max(2, static_cast<int>(std::ceil(kPerDecade * std::log10(highest / lowest))));
  for (int i = 0; i <= count; ++i)
    omega_.push_back(lowest * std::pow(highest / lowest, static_cast<double>(i) / count));
  omega_.back() = highest;
}

bool PulseResponse::hasDecayed(double part) const {
  const Index n = reached_.front().cols(), tail = n / 10;
  return std::all_of(reached_.begin(), reached_.end(), [&](const Matrix& r) {
    return r.allFinite() && swing(r, n - tail, tail) <= part * swing(r, 0, n);
  });
}

double PulseResponse::growth() const {
  const Index n = reached_.front().cols(), quarter = n / 4;
  double largest = 0.0;
  for (const Matrix& r : reached_) {
    if (!r.allFinite()) return std::numeric_limits<double>::infinity();
    const double before = swing(r, n - 2 * quarter, quarter),
                 after = swing(r, n - quarter, quarter);
    if (after > 0.0)
      largest = std::max(largest, std::pow(after / before, 1.0 / static_cast<double>(quarter)));
  }
  return largest;
}

/// Sum of r_k z^k over the samples, z = e^(-j omega T), at each frequency: by Horner's rule.
Eigen::ArrayXcd PulseResponse::transform(Index from, Index to, const Eigen::ArrayXd& omega) const {
  const Matrix& r = reached_[static_cast<std::size_t>(from)];
  const Eigen::ArrayXd real = (omega * sample_time_).cos(),
                       imaginary = -(omega * sample_time_).sin();
  Eigen::ArrayXd x = Eigen::ArrayXd::Zero(omega.size()), y = x, next(omega.size());
  for (Index k = r.cols(); k-- > 0;) {
    next = x * real - y * imaginary + r(to, k);
    y = x * imaginary + y * real;
    x.swap(next);
  }
  Eigen::ArrayXcd sums(omega.size());
  sums.real() = x;
  sums.imag() = y;
  return sums;
}

Complex PulseResponse::loopGain(Index input, double omega) const {
  return 1.0 / transform(input, input, Eigen::ArrayXd::Constant(1, omega))[0] - 1.0;
}

double PulseResponse::peak() const {
  const auto n_u = static_cast<Index>(reached_.size());
  const Eigen::Map<const Eigen::ArrayXd> omega(omega_.data(), static_cast<Index>(omega_.size()));
  std::vector<Eigen::MatrixXcd> S(omega_.size(), Eigen::MatrixXcd(n_u, n_u));
  for (Index i = 0; i < n_u; ++i)
    for (Index j = 0; j < n_u; ++j) {
      const Eigen::ArrayXcd entry = transform(j, i, omega);
      for (std::size_t w = 0; w < S.size(); ++w) S[w](i, j) = entry[static_cast<Index>(w)];
    }
  double largest = 0.0;
  for (const Eigen::MatrixXcd& at : S)
    largest = std::max(largest, Eigen::JacobiSVD<Eigen::MatrixXcd>(at).singularValues()[0]);
  return largest;
}

LoopMargins PulseResponse::margins(Index input) const {
  LoopMargins found{std::numeric_limits<double>::infinity(), 0.0, 180.0,
                    std::numeric_limits<double>::infinity(), 0.0};
  const auto L = [&](double omega) { return loopGain(input, omega); };
  const auto takeReal = [&](double omega) {
    const double real = L(omega).real();
    if (real >= 0.0) return;
    const double factor = -1.0 / real;
    if (factor > 1.0)
      found.gain_upper = std::min(found.gain_upper, factor);
    else
      found.gain_lower = std::max(found.gain_lower, factor);
  };
  const auto takeUnit = [&](double omega) {
    const double turn = std::arg(-L(omega));  // to -1, within half a turn; > 0: to be lost by delay
    found.phase_deg = std::min(found.phase_deg, std::abs(turn) * 180.0 / kHalfTurn);
    found.delay_s = std::min(found.delay_s, (turn < 0.0 ? turn + 2.0 * kHalfTurn : turn) / omega);
    found.crossover_rad_s = std::max(found.crossover_rad_s, omega);
  };
  const Eigen::Map<const Eigen::ArrayXd> omega(omega_.data(), static_cast<Index>(omega_.size()));
  const Eigen::ArrayXcd gains = 1.0 / transform(input, input, omega) - 1.0;
  for (std::size_t i = 1; i < omega_.size(); ++i) {
    const Complex before = gains[static_cast<Index>(i) - 1], now = gains[static_cast<Index>(i)];
    if ((before.imag() > 0.0) != (now.imag() > 0.0))
      takeReal(signChange(omega_[i - 1], omega_[i], [&](double w) { return L(w).imag(); }));
    if ((std::abs(before) > 1.0) != (std::abs(now) > 1.0))
      takeUnit(
          signChange(omega_[i - 1], omega_[i], [&](double w) { return std::abs(L(w)) - 1.0; }));
  }
  takeReal(0.0);  // there, and at the end, L is real
  takeReal(omega_.back());
  return found;
}

}  // namespace fpc
