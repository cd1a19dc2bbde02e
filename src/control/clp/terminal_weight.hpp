// Terminal weight of a dual-mode cost: the infinite sum of mode 2, added up by doubling in fixed
// storage.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// P = sum_{k>=0} Phi'^k (Phi' Q Phi + K' R K) Phi^k. Allocates at construction only.
class TerminalWeight {
 public:
  explicit TerminalWeight(Eigen::Index n_x);
  /// False if Phi (n_x n_x) is not stable; then weight() means nothing.
  bool compute(MatrixRef Phi, MatrixRef Q, MatrixRef KRK);
  const Matrix& weight() const { return weight_; }

 private:
  Matrix weight_, power_, scratch_, product_;
};

}  // namespace fpc
