// Structure files: what a user states before identification, as YAML.
#pragma once

#include <string>
#include <vector>

#include "identification/prior_knowledge.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// Keys: docs/structure_file.md. `known`: takes what is known of each output; without it such
/// statements are refused, since nobody would keep them. @throws InputError naming file, line, key.
Structure readStructure(const std::string& file, std::vector<PriorKnowledge>* known = nullptr);
Structure parseStructure(const std::string& text, const std::string& name,
                         std::vector<PriorKnowledge>* known = nullptr);

/// What is known of each output of a structure: a file, or (with a colon) its text, whose keys are
/// outputs with a body like `known` in a structure file. @throws InputError naming place and key.
std::vector<PriorKnowledge> readKnown(const std::string& text, const Structure& structure);

}  // namespace fpc
