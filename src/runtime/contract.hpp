// What every plant and every type of controller promises to the rest, ours and other packages':
// `fmbpc check` and the tests ask here.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc {

struct Promise {
  std::string name;    ///< what is promised, in words
  std::string broken;  ///< how it was broken; empty: it is kept
};

/// `type`: the name it is registered by.
std::vector<Promise> plantPromises(const Plant& plant, const std::string& type);
/// On the first samples of a loop with a simulated plant, of more than 60 samples.
std::vector<Promise> controllerPromises(const LoopFile& loop);

}  // namespace fpc
