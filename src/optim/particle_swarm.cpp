#include "fmbpc/optim/particle_swarm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Uniform in [0, 1) from the generator's bits alone: the same on every standard library.
double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

class Swarm {
 public:
  Swarm(const std::function<double(const Vector&)>& cost, const Vector& lower, const Vector& upper,
        const SwarmParams& params)
      : cost_(cost),
        lower_(lower),
        upper_(upper),
        params_(params),
        generator_(params.seed),
        places_(lower.size(), params.particles),
        speeds_(places_),
        own_best_(places_),
        own_cost_(Vector::Constant(params.particles, kInfinity)) {
    result_.cost = kInfinity;
  }

  void scatter(const Vector& start) {
    const Vector range = upper_ - lower_;
    for (Eigen::Index p = 0; p < places_.cols(); ++p)
      for (Eigen::Index i = 0; i < places_.rows(); ++i) {
        places_(i, p) = lower_[i] + uniform(generator_) * range[i];
        speeds_(i, p) = params_.speed_upper * (uniform(generator_) - 0.5) * range[i];
      }
    if (start.size() > 0) places_.col(0) = start.cwiseMax(lower_).cwiseMin(upper_);
    own_best_ = places_;
    result_.best = places_.col(0);
    evaluate();
  }

  void evaluate() {
    for (Eigen::Index p = 0; p < places_.cols(); ++p) {
      const double value = cost_(places_.col(p));
      ++result_.evaluations;
      if (!(value < own_cost_[p])) continue;
      own_cost_[p] = value;
      own_best_.col(p) = places_.col(p);
      if (!(value < result_.cost)) continue;
      result_.cost = value;
      result_.best = places_.col(p);
    }
  }

  void move(double inertia) {
    for (Eigen::Index p = 0; p < places_.cols(); ++p)
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

  SwarmResult& result() { return result_; }

 private:
  const std::function<double(const Vector&)>& cost_;
  const Vector &lower_, &upper_;
  const SwarmParams& params_;
  std::mt19937_64 generator_;
  Matrix places_, speeds_, own_best_;  // one column per particle
  Vector own_cost_;
  SwarmResult result_;
};

}  // namespace

void SwarmParams::validate() const {
  require(particles >= 1, "swarm.particles", "an integer >= 1");
  require(iterations >= 0, "swarm.iterations", "an integer >= 0");
  for (const double inertia : {inertia_start, inertia_end})
    require(std::isfinite(inertia) && inertia >= 0.0, "swarm.inertia", "a finite number >= 0");
  for (const double pull : {cognitive, social})
    require(std::isfinite(pull) && pull >= 0.0, "swarm.cognitive, social", "finite numbers >= 0");
  require(speed_upper > 0.0 && speed_upper <= 1.0, "swarm.speed_upper", "a number in (0, 1]");
}

SwarmResult minimizeBySwarm(const std::function<double(const Vector&)>& cost, const Vector& lower,
                            const Vector& upper, const SwarmParams& params, const Vector& start,
                            const SwarmProgress& progress) {
  params.validate();
  require(lower.size() > 0 && lower.size() == upper.size(), "swarm: bounds",
          "one lower and one upper bound for each dimension");
  require(lower.allFinite() && upper.allFinite() && (lower.array() <= upper.array()).all(),
          "swarm: bounds", "finite numbers, lower <= upper");
  require(start.size() == 0 || (start.size() == lower.size() && start.allFinite()), "swarm: start",
          "one finite number for each dimension");
  Swarm swarm(cost, lower, upper, params);
  swarm.scatter(start);
  for (int t = 0; t < params.iterations; ++t) {
    if (progress && progress(t, swarm.result())) {
      swarm.result().stopped = true;
      break;
    }
    const double part =
        params.iterations > 1 ? static_cast<double>(t) / (params.iterations - 1) : 0.0;
    swarm.move(params.inertia_start + part * (params.inertia_end - params.inertia_start));
    swarm.evaluate();
  }
  return swarm.result();
}

}  // namespace fpc
