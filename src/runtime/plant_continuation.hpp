// A plant as the analysis room wants it: one input varies, the rest stays nominal.
#pragma once

#include <memory>

#include "analysis/continuation.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {

struct PlantContinuation {
  ContinuationProblem problem;
  ContinuationParams params;
};

/// Continuation of `plant` over one input in [lower, upper], or over the description's range of it
/// where lower > upper or both are negative (cut at three times the nominal value; of an input that
/// rests at 0, at ten tenths of its range or 10). States are counted in their nominal values. A
/// plant with a local loop is judged as the map from sample to sample, any other by its Jacobian.
/// @throws InputError unless the input exists.
PlantContinuation plantContinuation(std::shared_ptr<const Plant> plant, Eigen::Index input,
                                    double sample_time_s, double lower, double upper);

}  // namespace fpc
