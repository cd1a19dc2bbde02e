#include "control/clp/params.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void requireWeights(const Vector& weight, Eigen::Index size, bool positive, const char* name) {
  if (weight.size() == 0) return;
  const std::string expected = positive ? " finite numbers > 0" : " finite numbers >= 0";
  require(weight.size() == size && weight.allFinite() &&
              (positive ? weight.minCoeff() > 0.0 : weight.minCoeff() >= 0.0),
          std::string("clp.") + name, std::to_string(size) + expected);
}

void requireLimits(const Vector& lower, const Vector& upper, Eigen::Index size,
                   const char* signal) {
  const std::string key = std::string("clp.") + signal;
  const std::string expected = std::to_string(size) + " numbers, none NaN";
  for (const Vector* limit : {&lower, &upper}) {
    const bool fits = limit->size() == 0 || (limit->size() == size && !limit->hasNaN());
    require(fits, key + (limit == &lower ? "_lower" : "_upper"), expected);
  }
  if (lower.size() == 0 || upper.size() == 0) return;
  require((lower.array() <= upper.array()).all(), key + "_upper",
          "numbers not below " + key + "_lower");
}

void requireTargets(const std::vector<int>& outputs, Eigen::Index n_y, Eigen::Index n_u,
                    const std::string& key) {
  const bool distinct = [sorted = outputs]() mutable {
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  }();
  const bool inside = std::all_of(outputs.begin(), outputs.end(),
                                  [n_y](int o) { return o >= 0 && o < static_cast<int>(n_y); });
  const bool enough = outputs.empty() || static_cast<Eigen::Index>(outputs.size()) == n_u;
  require(distinct && inside && enough, key,
          "least_perturbation and absolute bounds where the law steers " +
              std::to_string(outputs.size()) + " outputs by " + std::to_string(n_u) + " inputs");
}

void fillIfEmpty(Vector& field, Eigen::Index size, double value) {
  if (field.size() == 0) field = Vector::Constant(size, value);
}

}  // namespace

bool needsTarget(const ClpParams& params) {
  return params.cost == ClpCostKind::kLq || params.bounds == ClpBounds::kIncremental;
}

void ClpParams::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  require(perturbation_steps >= 1, "clp.perturbation_steps", "an integer >= 1");
  requireWeights(weight_perturbation, n_u, true, "weight_perturbation");
  requireWeights(weight_tracking, n_y, false, "weight_tracking");
  requireWeights(weight_state_output, n_y, false, "weight_state_output");
  requireWeights(weight_input, n_u, true, "weight_input");
  requireWeights(output_weight, n_y, true, "output_weight");
  requireLimits(increment_lower, increment_upper, n_u, "increment");
  requireLimits(output_lower, output_upper, n_y, "output");
  require(std::isfinite(output_penalty) && output_penalty > 0.0, "clp.output_penalty",
          "a finite number > 0");
  if (bounds == ClpBounds::kIncremental) {
    require(increment_lower.size() == n_u, "clp.increment_lower", "as many numbers as inputs");
    require(increment_upper.size() == n_u, "clp.increment_upper", "as many numbers as inputs");
  }
  const std::string key = cost == ClpCostKind::kLq ? "clp.cost" : "clp.bounds";
  requireTargets(target_outputs, n_y, n_u, key);
  if (needsTarget(*this) && n_y != n_u) {
    require(!target_outputs.empty(), key,
            "as many outputs as there are inputs, for lq and for incremental bounds");
  }
  qp.validate();
}

ClpParams filledIn(ClpParams params, Eigen::Index n_y, Eigen::Index n_u) {
  params.validate(n_y, n_u);
  fillIfEmpty(params.weight_perturbation, n_u, 1.0);
  fillIfEmpty(params.weight_tracking, n_y, 0.0);
  fillIfEmpty(params.weight_state_output, n_y, 1.0);
  fillIfEmpty(params.weight_input, n_u, 1.0);
  fillIfEmpty(params.increment_lower, n_u, -kInfinity);
  fillIfEmpty(params.increment_upper, n_u, kInfinity);
  fillIfEmpty(params.output_weight, n_y, 1.0);
  fillIfEmpty(params.output_lower, n_y, -kInfinity);
  fillIfEmpty(params.output_upper, n_y, kInfinity);
  if (params.target_outputs.empty() && needsTarget(params)) {
    for (int o = 0; o < static_cast<int>(n_u); ++o) params.target_outputs.push_back(o);
  }
  return params;
}

}  // namespace fpc
