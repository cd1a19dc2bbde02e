// `fmbpc identify --auto`.
#pragma once

#include "tool/commands.hpp"

namespace fpc::tool {

int identifyStructure(const IdentifyArguments& arguments);  ///< with a structure file
int identifyAuto(const IdentifyArguments& arguments);

}  // namespace fpc::tool
