// An affine law of what is measured, as plants set their aeration by load and flow:
//
//   value_i = sum of gain (s_1 s_2 ... / about - 1),   each through a first-order lag
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct AffineTerm {
  Eigen::Index target{};                            ///< the value it is part of
  std::vector<Eigen::Index> outputs, disturbances;  ///< measured signals, multiplied
  double about{1.0};                                ///< their product at which the term is 0, not 0
  double gain{};                                    ///< of the target
  double lag_h{};                                   ///< time constant; 0: none
};

class AffineLaw {
 public:
  AffineLaw() = default;
  /// @throws InputError naming the field.
  AffineLaw(std::vector<AffineTerm> terms, Eigen::Index targets, double sample_time_h);

  bool empty() const { return terms_.empty(); }
  /// Forgets the lags: the next sample starts them where they would rest.
  void reset();
  /// The values at this sample. Terms of signals that are not finite stay as
  /// they were. Steps increase; over skipped steps the lags catch up. No allocation.
  const Vector& follow(VectorRef outputs, VectorRef disturbances, std::uint32_t step);

 private:
  std::vector<AffineTerm> terms_;
  std::vector<double> value_;  // of each term behind its lag
  Vector sum_;                 // by target
  double sample_time_h_{};
  std::uint32_t last_step_{};
  bool fresh_{true};
};

}  // namespace fpc
