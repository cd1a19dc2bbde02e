// Section `candidate` of a loop file, without the candidate itself.
#pragma once

#include <array>

namespace fpc {

/// How a law that waits for its turn is judged, and how it gets it.
struct CandidateParams {
  /// Shares of the allowed moves that it is given one after the other.
  static constexpr std::array<double, 3> authority{0.25, 0.5, 1.0};
  static constexpr int samples = 200;         ///< before it is first judged
  static constexpr int horizon = 20;          ///< longest prediction that is judged, in samples
  static constexpr double confidence = 0.99;  ///< of a verdict
  static constexpr int step_samples = 50;     ///< of each authority, and the window that is watched
  bool automatic{false};                      ///< handed over as soon as it has passed
};

}  // namespace fpc
