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

Eigen::MatrixXcd PulseResponse::sensitivity(double omega) const {
  const auto n_u = static_cast<Index>(reached_.size());
  Eigen::MatrixXcd S = Eigen::MatrixXcd::Zero(n_u, n_u);
  for (Index j = 0; j < n_u; ++j) {
    const Matrix& r = reached_[static_cast<std::size_t>(j)];
    for (Index k = 0; k < r.cols(); ++k)
      S.col(j) += r.col(k) * std::polar(1.0, -omega * sample_time_ * static_cast<double>(k));
  }
  return S;
}

Complex PulseResponse::loopGain(Index input, double omega) const {
  const Matrix& r = reached_[static_cast<std::size_t>(input)];
  Complex S = 0.0;
  for (Index k = 0; k < r.cols(); ++k)
    S += r(input, k) * std::polar(1.0, -omega * sample_time_ * static_cast<double>(k));
  return 1.0 / S - 1.0;
}

double PulseResponse::peak() const {
  double largest = 0.0;
  for (const double omega : omega_)
    largest = std::max(largest,
                       Eigen::JacobiSVD<Eigen::MatrixXcd>(sensitivity(omega)).singularValues()[0]);
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
  Complex before = L(omega_.front());
  for (std::size_t i = 1; i < omega_.size(); ++i) {
    const Complex now = L(omega_[i]);
    if ((before.imag() > 0.0) != (now.imag() > 0.0))
      takeReal(signChange(omega_[i - 1], omega_[i], [&](double w) { return L(w).imag(); }));
    if ((std::abs(before) > 1.0) != (std::abs(now) > 1.0))
      takeUnit(
          signChange(omega_[i - 1], omega_[i], [&](double w) { return std::abs(L(w)) - 1.0; }));
    before = now;
  }
  takeReal(0.0);  // there, and at the end, L is real
  takeReal(omega_.back());
  return found;
}

}  // namespace fpc
