// Transport delays before any structure is known.
#pragma once

#include "fuzzy/auto_data.hpp"

namespace fpc {

/// Delays of inputs and disturbances [samples], 0 = acts on the next output; by one-step least
/// squares, one signal after the other, first up to 10 samples, then beyond where that lowers the
/// error by as much as a delay must.
struct DelayGuess {
  std::vector<int> delay;
  std::vector<bool> doubt;       ///< the runner-up is as good
  std::vector<int> by_free_run;  ///< of first-order lags that run freely, where these say otherwise
};
DelayGuess guessDelays(const AutoData& prepared, int longest);

}  // namespace fpc
