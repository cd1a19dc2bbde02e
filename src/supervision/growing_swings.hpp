// An input that swings, each time further: a loop that is not stable.
#pragma once

#include <cstdint>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// A half swing is the way from one turn to the next; a way back by less than kTurns of it is none.
/// Found are so many half swings in a row of which each is longer than the one before, with whole
/// swings that last alike: the longest at most kRegular times the shortest. Only ratios count, so
/// it is found long before a limit is reached. Eight are found in at most 0.3 % of runs of 1000
/// samples of white noise, and in 6 % where noise excites a resonance with poles at radius 0.9.
class GrowingSwings {
 public:
  static constexpr double kTurns = 0.5, kRegular = 4.0 / 3.0;
  static constexpr int kFewest = 3, kMost = 20;

  /// @param half_swings 0 never finds any, else kFewest to kMost.
  /// @param n_y of the outputs beside it.
  GrowingSwings(int half_swings, Eigen::Index n_y);
  void reset();
  /// One sample of the input, and the outputs; a value that is not finite is passed over. No
  /// allocation. @return whether they have been found at this sample.
  bool add(double value, VectorRef outputs);
  /// Once they are found: input and outputs between the newest two turns, about which they swing.
  void middle(double& input, Vector& outputs) const;

 private:
  struct Turn {
    std::int64_t step;
    double value;
    Vector outputs;  // where it was seen
  };
  void turn(VectorRef outputs);
  bool grow() const;

  std::size_t known_{0};
  std::vector<Turn> turns_;  // the newest, oldest first; known_ of them are filled at the end
  std::int64_t farthest_step_{0}, step_{0};
  double farthest_{0.0};  // since the newest turn
  int way_{0};            // 1 up, -1 down, 0 not known
};

}  // namespace fpc
