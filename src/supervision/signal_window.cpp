#include "supervision/signal_window.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kBlocks = 8;
constexpr double kSurelyNoise =
    8.0;  // standard deviations: the range of four means of noise is less

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

double SignalWindow::variance(Index signal, Index samples) const {
  const double about = mean(signal, samples);
  double sum = 0.0;
  for (Index k = 0; k < samples; ++k) sum += (at(signal, k) - about) * (at(signal, k) - about);
  return sum / static_cast<double>(samples - 1);
}

double SignalWindow::noiseOf(Index signal, Index age, Index samples) const {
  double sum = 0.0;
  for (Index k = age; k + 1 < age + samples; ++k) {
    const double step = at(signal, k + 1) - at(signal, k);
    sum += step * step;
  }
  return sum / static_cast<double>(2 * (samples - 1));
}

bool SignalWindow::meansMove(Index signal, Index samples, double change) const {
  const Index block = samples / kBlocks, half = samples / 2;
  double least = meanOf(signal, half, block), most = least;
  for (Index age = half + block; age + block <= samples; age += block) {
    const double mean = meanOf(signal, age, block);
    least = std::min(least, mean);
    most = std::max(most, mean);
  }
  const double inside = noiseOf(signal, half, samples - half);
  const double noise = kSurelyNoise * std::sqrt(inside / static_cast<double>(block));
  return most - least > change + noise;
}

}  // namespace fpc
