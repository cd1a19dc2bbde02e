#include "plant/transfer_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kMostSamples = 1e6;
constexpr double kSnap =
    1e-9;  // samples: a dead time this near to whole samples is meant to be whole

/// (exp(-p) - exp(-q)) / (q - p), and its limit; only the slower decay is taken out, so that time
/// constants of any ratio stay finite.
double meanDecay(double p, double q) {
  const double gap = std::abs(q - p);
  return std::exp(-std::min(p, q)) * (gap < 1e-12 ? 1.0 : -std::expm1(-gap) / gap);
}

}  // namespace

TransferStepper::TransferStepper(const TransferMatrixPlant& plant, double sample_time_s)
    : plant_(plant), shares_(static_cast<Eigen::Index>(plant.places().size())) {
  const double sample_time = sample_time_s / plant.matrix().time_unit_s;
  for (const TransferElement& e : plant.matrix().elements) {
    double samples = e.dead_time / sample_time;
    require(samples <= kMostSamples, "plant.matrix: dead time of " + e.output + " from " + e.from,
            "at most 1e6 samples");
    if (std::abs(samples - std::round(samples)) < kSnap) samples = std::round(samples);
    const double whole = std::floor(samples);
    Delay delay;
    delay.past.assign(static_cast<std::size_t>(whole) + 2, 0.0);
    delay.first = (samples - whole) * sample_time;
    delay.second = sample_time - delay.first;
    delays_.push_back(std::move(delay));
  }
}

void TransferStepper::reset(VectorRef u, VectorRef d) {
  for (std::size_t i = 0; i < delays_.size(); ++i) {
    const auto& p = plant_.places()[i];
    const double value = (p.from_disturbance ? d : u)[p.source] - p.source_nominal;
    std::fill(delays_[i].past.begin(), delays_[i].past.end(), value);
    delays_[i].next = 0;
  }
}

/// Two lags in a row under a held input, exact also where both are equal.
void TransferStepper::move(std::size_t i, double drive, double time, double& inner,
                           double& share) const {
  if (time <= 0.0) return;
  const TransferElement& e = plant_.matrix().elements[i];
  const double decay = std::exp(-time / e.time_constant);
  double push = 0.0;
  if (e.second_time_constant > 0.0) {
    const double p = time / e.time_constant, q = time / e.second_time_constant;
    push = (inner - drive) * p * meanDecay(p, q);
    inner = drive + (inner - drive) * std::exp(-q);
  }
  share = drive + (share - drive) * decay + push;
}

void TransferStepper::advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) {
  const auto& places = plant_.places();
  for (std::size_t i = 0; i < places.size(); ++i)
    shares_[static_cast<Eigen::Index>(i)] = plant_.share(i, x);
  for (const auto& p : places) x[p.output] = p.output_nominal;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& p = places[i];
    Delay& delay = delays_[i];
    delay.past[delay.next] = (p.from_disturbance ? d : u)[p.source] - p.source_nominal;
    delay.next = (delay.next + 1) % delay.past.size();
    const double older = delay.past[delay.next];
    const double newer = delay.past[(delay.next + 1) % delay.past.size()];
    double& share = shares_[static_cast<Eigen::Index>(i)];
    double inner = p.inner >= 0 ? x[p.inner] : 0.0;
    move(i, d[p.gain] * older, delay.first, inner, share);
    move(i, d[p.gain] * newer, delay.second, inner, share);
    if (p.inner >= 0) x[p.inner] = inner;
    if (p.share >= 0) x[p.share] = share;
    x[p.output] += share;
  }
}

}  // namespace fpc
