#include "runtime/plant_continuation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "analysis/linearise.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kFarthest = 3.0;  // starts and inputs, in nominal values

/// A signal that rests at 0 says nothing of its size: a tenth of its range, at most 1.
double sizeOf(const Quantity& q) {
  if (q.nominal != 0.0) return std::max(std::abs(q.nominal), 1e-3);
  return std::clamp(0.1 * (q.upper - q.lower), 1e-3, 1.0);
}

/// The part of an input's range that is looked at unless said.
std::pair<double, double> usualRange(const Quantity& q) {
  const double far = q.nominal != 0.0 ? kFarthest * std::abs(q.nominal) : 10.0 * sizeOf(q);
  const double upper = std::min(q.upper, std::max(far, q.nominal));
  const double lower = std::max(q.lower, -far);
  return {q.lower >= 0.0 ? std::max(lower, 0.01 * upper) : lower, upper};
}

Vector nominal(const std::vector<Quantity>& quantities) {
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = quantities[i].nominal;
  return values;
}

/// What the plant looks like with everything but one input at rest.
struct Held {
  std::shared_ptr<const Plant> plant;
  Vector u, d, state_size, input_size;
  Eigen::Index input{};
  double sample_time{};  ///< in the plant's time unit

  Vector inputs(double parameter) const {
    Vector all = u;
    all[input] = parameter;
    return all;
  }
  Matrix ofState(VectorRef x, double parameter) const {
    const Vector all = inputs(parameter);
    return jacobian([&](VectorRef at, Eigen::Ref<Vector> f) { plant->derivatives(at, all, d, f); },
                    x, x.size(), state_size);
  }
  Matrix ofInput(VectorRef x, double parameter) const {
    return jacobian([&](VectorRef at, Eigen::Ref<Vector> f) { plant->derivatives(x, at, d, f); },
                    inputs(parameter), x.size(), input_size);
  }
  Matrix localLoop(VectorRef x, double parameter, bool now) const {
    const VectorFunction loop = [&](VectorRef at, Eigen::Ref<Vector> value) {
      Vector all = inputs(parameter);
      plant->localLoop(now ? Vector(at) : Vector(x), now ? Vector(x) : Vector(at), all);
      value = all;
    };
    return jacobian(loop, x, u.size(), state_size);
  }
};

}  // namespace

PlantContinuation plantContinuation(std::shared_ptr<const Plant> plant, Eigen::Index input,
                                    double sample_time_s, double lower, double upper) {
  const PlantDescription& about = plant->description();
  require(input >= 0 && input < static_cast<Eigen::Index>(about.inputs.size()), "input",
          "an input of the plant");
  const Quantity& varied = about.inputs[static_cast<std::size_t>(input)];
  PlantContinuation set;
  ContinuationParams& p = set.params;
  const bool whole = lower > upper || (lower < 0.0 && upper < 0.0);
  std::tie(p.lower, p.upper) = whole ? usualRange(varied) : std::pair{lower, upper};
  Held held{plant,
            nominal(about.inputs),
            nominal(about.disturbances),
            {},
            {},
            input,
            sample_time_s / about.time_unit_s};
  p.starts = nominal(about.states);
  const auto n = static_cast<Eigen::Index>(about.states.size());
  p.state_lower.resize(n);
  p.state_upper.resize(n);
  p.state_size.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Quantity& q = about.states[static_cast<std::size_t>(i)];
    p.state_size[i] = sizeOf(q);
    p.state_lower[i] = q.lower;
    p.state_upper[i] = q.nominal != 0.0 ? std::min(q.upper, 10.0 * p.state_size[i]) : q.upper;
  }
  held.state_size = p.state_size;
  held.input_size = held.u.cwiseAbs().cwiseMax(1e-3);
  p.step_max = 0.1;
  p.parameter_size = sizeOf(varied);
  set.problem.field = [held](VectorRef x, double parameter, Eigen::Ref<Vector> f) {
    held.plant->derivatives(x, held.inputs(parameter), held.d, f);
  };
  const Vector rest = p.starts.col(0);
  set.problem.map = held.localLoop(rest, varied.nominal, true).cwiseAbs().maxCoeff() > 0.0;
  if (set.problem.map)
    set.problem.linearisation = [held](VectorRef x, double parameter) {
      return sampledLocalLoop(held.ofState(x, parameter), held.ofInput(x, parameter),
                              held.sample_time, held.localLoop(x, parameter, true),
                              held.localLoop(x, parameter, false));
    };
  return set;
}

}  // namespace fpc
