// Section `candidate` of a loop file, without the candidate itself.
#pragma once

#include <vector>

namespace fpc {

/// How a law that waits for its turn is judged, and how it gets it.
struct CandidateParams {
  int samples{200};                             ///< before it is first judged
  int horizon{20};                              ///< longest prediction that is judged, in samples
  double confidence{0.99};                      ///< of a verdict
  std::vector<double> authority{0.25, 0.5, 1};  ///< increasing, the last one 1
  int step_samples{50};   ///< of each authority, and the window that is watched
  bool automatic{false};  ///< handed over as soon as it has passed
  /// @throws InputError naming candidate.KEY.
  void validate() const;
};

}  // namespace fpc
