// Section `plausibility` of a loop file: what a measurement may be, and when an input is stuck.
#pragma once

#include "fmbpc/control/plausibility.hpp"

namespace fpc {

/// When an input is said not to follow its command.
struct StuckParams {
  int samples{5};          ///< in a row; 0: never
  double tolerance{0.02};  ///< of the input's range
};

struct PlausibilityFile {
  PlausibilityParams signals;
  StuckParams stuck;
};

struct LoopFile;
/// Of the loop's text, over defaults from its plant. @throws InputError naming the key.
PlausibilityFile plausibilityOf(const LoopFile& loop);

}  // namespace fpc
