#include "fmbpc/control/signal_window.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kBlocks = 8;
constexpr double kSurely = 4.0;  // standard deviations

}  // namespace

void SignalWindow::add(const Measurement& now) {
  const Index n_y = now.outputs.size(), n_d = now.disturbances.size();
  values_.col(next_).head(n_y) = now.outputs;
  values_.col(next_).segment(n_y, n_d) = now.disturbances;
  values_.col(next_).tail(now.input_applied.size()) = now.input_applied;
  next_ = (next_ + 1) % values_.cols();
  known_ = std::min(known_ + 1, values_.cols());
}

double SignalWindow::span(Index signal, Index samples) const {
  double least = at(signal, 0), most = least;
  for (Index age = 1; age < samples; ++age) {
    least = std::min(least, at(signal, age));
    most = std::max(most, at(signal, age));
  }
  return most - least;
}

double SignalWindow::meanOf(Index signal, Index age, Index samples) const {
  double sum = 0.0;
  for (Index k = age; k < age + samples; ++k) sum += at(signal, k);
  return sum / static_cast<double>(samples);
}

double SignalWindow::varianceOf(Index signal, Index age, Index samples) const {
  if (samples < 2) return 0.0;
  const double mean = meanOf(signal, age, samples);
  double sum = 0.0;
  for (Index k = age; k < age + samples; ++k)
    sum += (at(signal, k) - mean) * (at(signal, k) - mean);
  return sum / static_cast<double>(samples - 1);
}

bool SignalWindow::meansMove(Index signal, Index samples, double part) const {
  const Index block = std::max<Index>(1, samples / kBlocks);
  double least = 0.0, most = 0.0, inside = 0.0;
  for (Index age = samples / 2; age + block <= samples; age += block) {
    const double mean = meanOf(signal, age, block);
    least = age == samples / 2 ? mean : std::min(least, mean);
    most = age == samples / 2 ? mean : std::max(most, mean);
    inside = std::max(inside, varianceOf(signal, age, block));
  }
  const double noise = kSurely * std::sqrt(inside / static_cast<double>(block));
  return most - least > part * std::abs(meanOf(signal, 0, samples)) + noise;
}

}  // namespace fpc
