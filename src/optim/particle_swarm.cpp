#include "optim/particle_swarm.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

void SwarmParams::validate() const {
  require(particles >= 1, "swarm.particles", "an integer >= 1");
  require(iterations >= 0, "swarm.iterations", "an integer >= 0");
  for (const double inertia : {inertia_start, inertia_end, adaptive_inertia})
    require(std::isfinite(inertia) && inertia >= 0.0, "swarm.inertia", "a finite number >= 0");
  for (const double pull : {cognitive, social})
    require(std::isfinite(pull) && pull >= 0.0, "swarm.cognitive, social", "finite numbers >= 0");
  require(speed_upper > 0.0 && speed_upper <= 1.0, "swarm.speed_upper", "a number in (0, 1]");
}

Swarm::Swarm(const Vector& lower, const Vector& upper, const SwarmParams& params,
             const Vector& start)
    : lower_(lower), upper_(upper), params_(params), generator_(params.seed) {
  params.validate();
  require(lower.size() > 0 && lower.size() == upper.size(), "swarm: bounds",
          "one lower and one upper bound for each dimension");
  require(lower.allFinite() && upper.allFinite() && (lower.array() <= upper.array()).all(),
          "swarm: bounds", "finite numbers, lower <= upper");
  require(start.size() == 0 || (start.size() == lower.size() && start.allFinite()), "swarm: start",
          "one finite number for each dimension");
  places_.resize(lower.size(), params.particles);
  speeds_ = places_;
  own_cost_ = Vector::Constant(params.particles, kInfinity);
  scatter(start);
}

void Swarm::scatter(const Vector& start) {
  for (Eigen::Index p = 0; p < places_.cols(); ++p)
    for (Eigen::Index i = 0; i < places_.rows(); ++i) {
      const double range = upper_[i] - lower_[i];
      places_(i, p) = lower_[i] + uniform(generator_) * range;
      speeds_(i, p) = params_.speed_upper * (uniform(generator_) - 0.5) * range;
    }
  if (start.size() > 0) places_.col(0) = start.cwiseMax(lower_).cwiseMin(upper_);
  own_best_ = places_;
  result_.best = places_.col(0);
  result_.cost = kInfinity;
}

void Swarm::restart(const Vector& lower, const Vector& upper, std::uint64_t seed,
                    const Vector& start) {
  lower_ = lower;
  upper_ = upper;
  generator_.seed(seed);
  own_cost_.setConstant(kInfinity);
  result_.evaluations = 0;
  moves_ = -1;
  scatter(start);
}

const Matrix& Swarm::next() {
  if (moves_ >= 0) move();
  ++moves_;
  return places_;
}

void Swarm::tell(const Vector& costs) {
  for (Eigen::Index p = 0; p < costs.size(); ++p) {
    ++result_.evaluations;
    if (!(costs[p] < own_cost_[p])) continue;
    own_cost_[p] = costs[p];
    own_best_.col(p) = places_.col(p);
    if (!(costs[p] < result_.cost)) continue;
    result_.cost = costs[p];
    result_.best = places_.col(p);
  }
}

double Swarm::likeness(double best, double own) {
  if (best == own) return 1.0;
  if (!std::isfinite(own) || own == 0.0) return 0.0;
  return std::clamp(best / own, 0.0, 1.0);
}

void Swarm::move() {
  const double part = params_.iterations > 1
                          ? std::min(1.0, static_cast<double>(moves_) / (params_.iterations - 1))
                          : 0.0;
  const double falling =
      params_.inertia_start + part * (params_.inertia_end - params_.inertia_start);
  for (Eigen::Index p = 0; p < places_.cols(); ++p) {
    const double inertia = params_.adaptive
                               ? params_.adaptive_inertia - likeness(result_.cost, own_cost_[p])
                               : falling;
    for (Eigen::Index i = 0; i < places_.rows(); ++i) {
      const double fastest = params_.speed_upper * (upper_[i] - lower_[i]);
      const double own = uniform(generator_), all = uniform(generator_);
      double& speed = speeds_(i, p);
      double& place = places_(i, p);
      speed = inertia * speed + params_.cognitive * own * (own_best_(i, p) - place) +
              params_.social * all * (result_.best[i] - place);
      speed = std::clamp(speed, -fastest, fastest);
      place += speed;
      if (place >= lower_[i] && place <= upper_[i]) continue;
      place = std::clamp(place, lower_[i], upper_[i]);
      speed = 0.0;
    }
  }
}

SwarmResult minimizeBySwarm(const std::function<double(const Vector&)>& cost, const Vector& lower,
                            const Vector& upper, const SwarmParams& params, const Vector& start,
                            const SwarmProgress& progress) {
  Swarm swarm(lower, upper, params, start);
  const auto generation = [&] {
    const Matrix points = swarm.ask();
    Vector costs(points.cols());
    for (Eigen::Index p = 0; p < points.cols(); ++p) costs[p] = cost(points.col(p));
    swarm.tell(costs);
  };
  generation();
  for (int t = 0; t < params.iterations; ++t) {
    if (progress && progress(t, swarm.result())) {
      SwarmResult result = swarm.result();
      result.stopped = true;
      return result;
    }
    generation();
  }
  return swarm.result();
}

}  // namespace fpc
