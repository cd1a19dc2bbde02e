// Section `guard` of a loop file.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// How far a law is let go on outside its model's data, and when it is said to be locked up.
struct GuardParams {
  bool enabled{true};
  double trust_low{0.25};   ///< below: the fallback takes over, or moves are smallest
  double trust_high{0.75};  ///< above: the law acts freely (again)
  double least_move{0.25};  ///< largest move at no trust, in parts of an input's range
  int look_ahead{10};       ///< samples of a plan that shrink moves; 0: the present one
  int horizon_least{12};    ///< errors after the dead time that count; 0: all do
  int return_samples{10};   ///< so long above trust_high before the law is back
  int lock_samples{0};      ///< an input so long at its bound is suspected; 0: never
  double lock_error{0.01};  ///< ... while an error is larger than this part of its output's range
  double lock_step{0.3};    ///< by how much the bound is drawn in at once, in parts of the range
  int lock_release{250};    ///< samples over which a drawn-in bound opens again
  int growing_swings{0};  ///< half swings in a row that grow: the fallback acts for good; 0: never
  std::vector<Eigen::Index> lock_outputs;  ///< whose errors count; empty: all
  /// @throws InputError naming guard.KEY.
  void validate(Eigen::Index n_y, bool has_fallback) const;
};

}  // namespace fpc
