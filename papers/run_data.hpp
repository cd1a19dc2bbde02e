// A run in this process as identification data.
#pragma once

#include <string>

#include "identification/data_set.hpp"
#include "runtime/record.hpp"

namespace fpc::papers {

/// Row k holds y(k) and the u(k), d(k) that act from then on; the last sample has no action and is
/// left out. @throws InputError naming a signal of the structure that the run does not have.
DataSet dataOf(const RunRecord& run, const Structure& structure);

}  // namespace fpc::papers
