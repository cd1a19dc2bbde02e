// Transport delays before any structure is known.
#pragma once

#include "identification/auto_data.hpp"

namespace fpc {

/// Delays of inputs and disturbances [samples], 0 = acts on the next output; by one-step least
/// squares, one signal after the other, up to 10 samples.
struct DelayGuess {
  std::vector<int> delay;
  std::vector<bool> doubt;  ///< the runner-up is as good
  /// With longer delays: by one-step least squares again, where that lowers the error by as much as
  /// a delay must; and by first-order lags that run freely. Equal to `delay` where these say
  /// nothing else; none if no longer ones were tried.
  std::vector<std::vector<int>> longer;

  /// Some of `longer` says something else.
  bool isOpen() const;
};
DelayGuess guessDelays(const AutoData& prepared, int longest);
/// The same from what the fit for each block may see: of outputs in the block nothing is known.
std::vector<DelayGuess> guessDelaysByBlock(const AutoData& prepared, int longest, int threads);

/// For each cause the least lag up to `delay` whose coefficient is certain (5 standard errors) in a
/// one-step model of four past outputs and all lags: an inverse response acts before most of its
/// effect comes. `delay` where none is.
std::vector<int> earliestDelays(const AutoData& prepared, const std::vector<int>& delay);

}  // namespace fpc
