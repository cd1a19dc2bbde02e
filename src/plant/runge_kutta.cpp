// The explicit pair of orders 5 and 4 by Dormand and Prince, carried on at order 5. Source:
// dormand1980, table 2 (RK5(4)7M); hairer1993, section II.4 for the choice of the step.
//
// A method of one step has nothing to lose at a sample, and its arithmetic is a few dozen numbers:
// a general library's administration of a sample costs several times as much.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "plant/sample_method.hpp"

namespace fpc {
namespace {

constexpr std::size_t kStages = 7;  // the last one is the first of the next step
/// Row i: x + h (sum over j of a_ij k_j) is where stage i + 2 stands; the last row is the new
/// state.
constexpr std::array<std::array<double, kStages - 1>, kStages - 1> kNodes{{
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
}};
/// Order 5 less order 4.
constexpr std::array<double, kStages> kError{
    71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
    -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
constexpr double kSafety = 0.9, kLeastChange = 0.1, kMostChange = 5.0;
constexpr double kShortest = 1e-13;  // of the sample: below it, time does not go on
constexpr double kRounding = 1e-6;   // of a step: no step of its own

class RungeKutta final : public SampleMethod {
 public:
  RungeKutta(const Plant& plant, const IntegratorParams& params)
      : SampleMethod(plant), params_(params), trial_(n_), slopes_(kStages * at(n_)) {}

 private:
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  double* slope(std::size_t stage) { return slopes_.data() + stage * at(n_); }

  IntegrationResult move(double time) override;
  /// Stages 2 to 7 of a step from state_, whose slope is the first; trial_ is where it ends.
  bool tryStep(double h);
  template <std::size_t kStage>
  bool stand(double h);
  /// Of the step tried, in tolerances: root of the mean square.
  double error(double h);
  IntegrationResult noStep() const;

  IntegratorParams params_;
  Vector trial_;
  std::vector<double> slopes_;
};

template <std::size_t kStage>
bool RungeKutta::stand(double h) {
  const double* k = slopes_.data();
  const auto n = at(n_);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = kNodes[kStage - 1][0] * k[i];
    for (std::size_t j = 1; j < kStage; ++j) sum += kNodes[kStage - 1][j] * k[j * n + i];
    trial_.data()[i] = state_.data()[i] + h * sum;
  }
  return evaluate(trial_.data(), slope(kStage)) == Equations::kFinite;
}

bool RungeKutta::tryStep(double h) {
  return stand<1>(h) && stand<2>(h) && stand<3>(h) && stand<4>(h) && stand<5>(h) && stand<6>(h);
}

double RungeKutta::error(double h) {
  const double* k = slopes_.data();
  const auto n = at(n_);
  double square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < kStages; ++j) sum += kError[j] * k[j * n + i];
    const double scaled =
        h * sum /
        (params_.relative_tolerance * std::abs(state_.data()[i]) + params_.absolute_tolerance);
    square += scaled * scaled;
  }
  const double root = std::sqrt(square / static_cast<double>(n));
  return std::isfinite(root) ? root : kInfinity;
}

IntegrationResult RungeKutta::noStep() const {
  if (!model_error_.empty())
    return {IntegrationStatus::kModelFailed, "the plant's equations failed: " + model_error_, 0};
  return {IntegrationStatus::kSolverFailed, "no step is short enough for the tolerances", 0};
}

/// The whole sample is tried as one step; one that is too far off, or leads where the equations do
/// not hold, is tried again shorter. Steps that were refused count.
IntegrationResult RungeKutta::move(double time) {
  if (evaluate(state_.data(), slope(0)) != Equations::kFinite) return noStep();
  double left = time, h = time, most = kMostChange;
  for (long steps = 1; steps <= params_.max_steps; ++steps) {
    model_error_.clear();
    const double off = tryStep(h) ? error(h) : kInfinity;
    if (off <= 1.0) {
      state_.swap(trial_);
      if (h >= left) return {IntegrationStatus::kOk, "", steps};
      left -= h;
      std::copy_n(slope(kStages - 1), n_, slope(0));
    }
    const double change = kSafety * std::pow(std::max(off, 1e-10), -0.2);
    h *= std::clamp(change, kLeastChange, off <= 1.0 ? most : 1.0);
    most = off <= 1.0 ? kMostChange : 1.0;
    if (!(h > kShortest * time)) return noStep();
    h = left / std::max(1.0, std::ceil(left / h - kRounding));  // equal steps to the end
  }
  IntegrationResult result{IntegrationStatus::kTooMuchWork,
                           "more integration steps than integrator.max_steps", params_.max_steps};
  if (!model_error_.empty()) result.reason += " (" + model_error_ + ")";
  return result;
}

}  // namespace

std::unique_ptr<SampleMethod> makeRungeKutta(const Plant& plant, const IntegratorParams& params) {
  return std::make_unique<RungeKutta>(plant, params);
}

}  // namespace fpc
