#include "supervision/actuator_effectiveness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Index = Eigen::Index;

constexpr double kFlat = 1e-7;       // of an output: a forecast that moves less says nothing
constexpr double kMostAlike = 0.98;  // of an autocorrelation

/// Mean, sum of squares about it, and autocorrelation at lag one.
struct Spread {
  double mean{}, squares{}, alike{};
};

template <typename At>
Spread spreadOf(Index n, const At& at) {
  Spread spread;
  for (Index k = 0; k < n; ++k) spread.mean += at(k);
  spread.mean /= static_cast<double>(n);
  double product = 0.0;
  for (Index k = 0; k < n; ++k) {
    const double value = at(k) - spread.mean;
    spread.squares += value * value;
    if (k > 0) product += value * (at(k - 1) - spread.mean);
  }
  if (spread.squares > 0.0) spread.alike = std::clamp(product / spread.squares, 0.0, 1.0);
  return spread;
}

}  // namespace

ActuatorEffectiveness::ActuatorEffectiveness(const TsModel& model, int samples)
    : parts_(model), names_(namesOf(model.inputs)) {
  require(samples >= 8, "plausibility.reaction_samples", "0 or an integer >= 8");
  const Index n_y = countOf(model.outputs), n_u = countOf(model.inputs);
  errors_ = Matrix::Zero(n_y, samples);
  phi_ = Matrix::Zero(n_y * n_u, samples);
  share_ = Vector::Zero(n_u);
  for (const std::string& name : names_)
    texts_.push_back("the outputs do not react to input " + name + " as the model says");
  reset();
}

void ActuatorEffectiveness::reset() {
  parts_.reset();
  filled_ = place_ = 0;
  share_.setConstant(kNaN);
  away_.assign(names_.size(), 0);
  dead_.assign(names_.size(), false);
  notice_ = {};
}

void ActuatorEffectiveness::look(const Measurement& now) {
  if (!parts_.look(now)) return;
  keep();
  if (filled_ == errors_.cols()) judge();
}

void ActuatorEffectiveness::keep() {
  errors_.col(place_) = parts_.error();
  phi_.col(place_) = parts_.effect();
  place_ = (place_ + 1) % errors_.cols();
  filled_ = std::min(filled_ + 1, errors_.cols());
}

void ActuatorEffectiveness::estimate(Index output, Index input, double& share,
                                     double& error) const {
  const Index n = errors_.cols(), row = input * errors_.rows() + output;
  const auto in_order = [&](Index k) { return (place_ + k) % n; };
  const auto phi = [&](Index k) { return phi_(row, in_order(k)); };
  const auto e = [&](Index k) { return errors_(output, in_order(k)); };
  const Spread moves = spreadOf(n, phi), errors = spreadOf(n, e);
  const double size = std::abs(parts_.state()[parts_.local().outputState(output)]);
  error = std::numeric_limits<double>::infinity();
  if (!(moves.squares > static_cast<double>(n) * std::pow(kFlat * size, 2.0))) return;
  double product = 0.0;
  for (Index k = 0; k < n; ++k) product += (phi(k) - moves.mean) * (e(k) - errors.mean);
  const double slope = product / moves.squares;
  const Spread rest = spreadOf(n, [&](Index k) { return e(k) - slope * (phi(k) - moves.mean); });
  const double alike = std::min(kMostAlike, rest.alike * moves.alike);
  error = std::sqrt(rest.squares / static_cast<double>(n - 2) / moves.squares * (1.0 + alike) /
                    (1.0 - alike));
  share = 1.0 + slope;
}

void ActuatorEffectiveness::judge() {
  notice_ = {};
  const int patience = std::max(3, static_cast<int>(errors_.cols() / 4));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto k = static_cast<Index>(i);
    double least = std::numeric_limits<double>::infinity(), share = kNaN;
    for (Index o = 0; o < errors_.rows(); ++o) {
      double here = kNaN, error = least;
      estimate(o, k, here, error);
      if (!(error < least)) continue;
      least = error;
      share = here;
    }
    const bool sure = least < kSure;
    share_[k] = sure ? share : kNaN;
    const bool away = sure && share + 2.0 * least < kLeast;
    away_[i] = away ? std::min(away_[i] + 1, patience) : 0;
    if (away_[i] == patience) dead_[i] = true;
    if (sure && share - 2.0 * least > kLeast) dead_[i] = false;
    if (dead_[i] && notice_.code == EventCode::kNone)
      notice_ = {EventCode::kActuatorIneffective, texts_[i].c_str(), names_[i].c_str()};
  }
}

}  // namespace fpc
