// An affine law of what is measured, as plants set their aeration by load and flow:
//
//   value_i = sum of gain (s_1 s_2 ... / about - 1)
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct AffineTerm {
  Eigen::Index target{};                   ///< the value it is part of
  std::vector<Eigen::Index> disturbances;  ///< measured ones, multiplied
  double about{1.0};                       ///< their product at which the term is 0, not 0
  double gain{};                           ///< of the target
};

class AffineLaw {
 public:
  AffineLaw() = default;
  /// @throws InputError naming the field.
  AffineLaw(std::vector<AffineTerm> terms, Eigen::Index targets);

  bool empty() const { return terms_.empty(); }
  /// The values at this sample. Terms of signals that are not finite stay as
  /// they were. No allocation.
  const Vector& follow(VectorRef disturbances);

 private:
  std::vector<AffineTerm> terms_;
  std::vector<double> value_;  // of each term
  Vector sum_;                 // by target
};

}  // namespace fpc
