#include "analysis/running_indices.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kMoved = 1e-9;

}  // namespace

RunningOutput::RunningOutput(double sample_time_h) : sample_time_h_(sample_time_h) {
  require(std::isfinite(sample_time_h) && sample_time_h > 0.0, "sample_time_h", "a number > 0");
}

void RunningOutput::add(double y, double setpoint, double reference) {
  const double e = setpoint - y;
  const double e_reference = reference - y;
  const double t = static_cast<double>(samples_++) * sample_time_h_;
  sums_.ise += e * e;
  sums_.iae += std::abs(e);
  sums_.itae += t * std::abs(e);
  sums_.itse += t * e * e;
  if (std::isnan(reference)) return;
  ++referred_;
  sums_.ise_reference += e_reference * e_reference;
}

OutputIndices RunningOutput::indices() const {
  OutputIndices result = sums_;
  const std::uint64_t counted = samples_ - sums_.rejected;
  if (referred_ == 0 && samples_ > 0) result.ise_reference = std::nan("");
  if (counted > 0) result.rmse = std::sqrt(sums_.ise / static_cast<double>(counted));
  if (counted > 0 || samples_ == 0) return result;
  for (double* sum :
       {&result.ise, &result.iae, &result.itae, &result.itse, &result.rmse, &result.ise_reference})
    *sum = std::nan("");
  return result;
}

RunningInput::RunningInput(double before) : before_(before), last_(before) {}

void RunningInput::add(double applied) {
  const double move = std::abs(applied - last_);
  last_ = applied;
  if (samples_++ == 0) sums_.min = sums_.max = applied;
  if (std::isnan(applied)) sums_.min = sums_.max = applied;  // and NaN they stay
  sums_.min = std::min(sums_.min, applied);
  sums_.max = std::max(sums_.max, applied);
  sums_.travel += move;
  sums_.effort += move * move;
  sums_.energy += applied * applied;
  sums_.switches += move > kMoved;
}

InputIndices RunningInput::indices() const {
  InputIndices result = sums_;
  if (samples_ == 0)
    result.min = result.max = before_;
  else
    result.mean_abs_move = sums_.travel / static_cast<double>(samples_);
  return result;
}

}  // namespace fpc
