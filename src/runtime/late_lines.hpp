// Measurements that come later than the model of the loop knows.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc {

/// A remark for each output that cannot show an input's effect when the model of the loop file
/// expects it, one a line. delays_s: transport delay of each measured output, as the plant has it.
std::string lateLines(const LoopFile& loop, const std::vector<double>& delays_s);

}  // namespace fpc
