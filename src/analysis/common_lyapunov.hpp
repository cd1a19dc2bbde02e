// A sufficient certificate for switching between linear maps, or blending them in any way: one
// quadratic function that decreases along all of them.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

enum class LyapunovStatus {
  kFound,
  kNone,      ///< the programme has no solution within tolerance: no common P, which proves
              ///< nothing about stability
  kNoSolver,  ///< the program csdp is not installed
  kTrouble,   ///< the solver gave nothing usable
};

struct CommonLyapunov {
  LyapunovStatus status{LyapunovStatus::kNone};
  Matrix P;           ///< symmetric, largest eigenvalue 1; of kFound only
  double decay{1.0};  ///< sqrt(x' P x) shrinks at least by this factor a sample, whichever map acts
  bool ok() const { return status == LyapunovStatus::kFound; }
};

/// P > 0 with A_i' P A_i < decay^2 P for all i, decay as small as bisection finds it. The
/// semidefinite programmes (largest t with decay^2 P - A_i' P A_i >= t I, 0 <= P <= I, in
/// coordinates where the mean map is round) go to CSDP; whatever it says, P counts only if its
/// Cholesky factor L exists and |L' A_i L'^-1| < 1 for every i, which is computed here.
/// Source: tanaka1992,
/// theorem 4.1; borchers1999 (CSDP).
/// @throws InputError unless all maps are square, of one size and finite.
CommonLyapunov commonLyapunov(const std::vector<Matrix>& maps);

/// Largest |L' A_i L'^-1| for P = L L'; infinite unless P is symmetric and positive definite.
double certifiedDecay(MatrixRef P, const std::vector<Matrix>& maps);

/// The largest set of maps found by taking them in the given order and keeping each that still
/// leaves a common P.
struct CertifiedRegion {
  std::vector<std::size_t> members;
  CommonLyapunov certificate;
};
CertifiedRegion largestRegion(const std::vector<Matrix>& maps,
                              const std::vector<std::size_t>& order);

}  // namespace fpc
