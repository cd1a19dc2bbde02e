// What is known of outputs, as structure files and --known say it.
#pragma once

#include "fmbpc/base/yaml_section.hpp"
#include "identification/prior_knowledge.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// The body of `known` of one output; `names` holds the signals.
PriorKnowledge readKnown(YamlSection section, const TsModel& names, std::size_t output);

}  // namespace fpc
