// Linear models out of a Takagi-Sugeno model: one rule of each output taken alone, or the rules
// blended at a point. Everything else in this room works on these.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/state_space.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// One rule of each output, counted from 0.
using RuleChoice = std::vector<std::size_t>;

/// A linear model and how the law finds u(k-1) in its state.
struct LinearModel {
  AffineModel affine;     ///< xi as in LocalModel
  Matrix previous_input;  ///< n_u n_x: u(k-1) = previous_input xi
};

/// Every combination of rules, the last output's rule running fastest.
std::vector<RuleChoice> ruleChoices(const TsModel& model);
/// "1/3": the rules of a choice as a person counts them.
std::string text(const RuleChoice& choice);
/// disturbances: n_d, they enter g only. @throws InputError on wrong sizes or rules out of range.
LinearModel ruleModel(const TsModel& model, const RuleChoice& choice, VectorRef disturbances);
/// The rules blended where the process rests at these values. @throws InputError on wrong sizes.
LinearModel blendedModel(const TsModel& model, VectorRef outputs, VectorRef input,
                         VectorRef disturbances);

}  // namespace fpc
