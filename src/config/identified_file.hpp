// Model files of `identify --auto`: a plain model file that every loop takes, with a section
// `identified` that holds the linear model, the model with a state of its own, limits and
// intervals.
#pragma once

#include <string>

#include "identification/identified_model.hpp"
#include "plant/model_plant.hpp"

namespace fpc {

/// Reads any model file; without the section only `model` is filled. @throws InputError naming
/// file, line and key.
IdentifiedModel readIdentified(const std::string& file);
IdentifiedModel parseIdentified(const std::string& text, const std::string& name);
std::string writeIdentified(const IdentifiedModel& model);
/// Of the model that loops take, from the intervals of its file; empty where they are not known.
ModelErrors modelErrorsOf(const IdentifiedModel& model);

}  // namespace fpc
