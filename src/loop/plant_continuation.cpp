#include "fmbpc/loop/plant_continuation.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/analysis/linearise.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kFarthest = 3.0;  // starts and inputs, in nominal values

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
  p.upper = whole ? std::min(varied.upper, std::max(kFarthest * varied.nominal, 1.0)) : upper;
  p.lower = whole ? std::max(varied.lower, 0.01 * p.upper) : lower;
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
    const double size = std::max(std::abs(q.nominal), 1e-3);
    p.state_size[i] = size;
    p.state_lower[i] = q.lower;
    p.state_upper[i] = std::min(q.upper, 10.0 * size);
  }
  held.state_size = p.state_size;
  held.input_size = held.u.cwiseAbs().cwiseMax(1e-3);
  p.step_max = 0.1;
  p.parameter_size = std::max(std::abs(varied.nominal), 1e-3);
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
