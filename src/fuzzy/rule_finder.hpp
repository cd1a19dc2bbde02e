// The rules of one output: clusters or grid, their number, and the consequents.
#pragma once

#include "fmbpc/fuzzy/identify.hpp"

namespace fpc {

/// Fills `model` and what `found` says about its rules. @return false when the callback cancelled.
bool findRules(const Regression& rows, const OutputStructure& structure, const Structure& settings,
               const OutputModel& linear, const IdentifyCallback& report,
               OutputIdentification& found, OutputModel& model);

}  // namespace fpc
