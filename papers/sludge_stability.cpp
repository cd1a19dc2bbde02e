// The reduced closed loop of the stability tables (vallejo2021a, eqs. 47, 59 and 64).
#include <algorithm>
#include <cmath>

#include "papers/expression.hpp"
#include "papers/paper_loop.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

const Matrix kA = (Matrix(2, 2) << 0.80, 0.77, 0.0, 0.88).finished();
const Matrix kB = (Matrix(2, 2) << 0.90, 0.57, 0.81, 0.0).finished();

/// reduced_loop(H, ROW, COLUMN): of A_CL.
Values reducedLoop(const Words& w) {
  return paperReducedLoop(kA, kB, static_cast<int>(toNumber(w[0])))(
      static_cast<Eigen::Index>(toIndex(w[1])), static_cast<Eigen::Index>(toIndex(w[2])));
}

/// second_eigenvalue(H): formula (59) with f = 0.88.
Values secondEigenvalue(const Words& w) {
  return paperSecondEigenvalue(0.88, static_cast<int>(toNumber(w[0])));
}

/// H = 6: how far an eigenvalue of the loop with u(k-1) as a state lies from both of the table's, 0
/// and eig2.
Values farthestEigenvalue(const Words&) {
  const ClosedLoop full = closeLoop(paperModel(kA, kB), LoopLaw{});
  const double second = paperSecondEigenvalue(0.88, LoopLaw{}.coincidence_steps);
  double most = 0.0;
  for (const auto& value : full.values)
    most = std::max(most, std::min(std::abs(value), std::abs(value - second)));
  return most;
}

const bool kRegistered = registerComputation("reduced_loop", 3, reducedLoop) &&
                         registerComputation("second_eigenvalue", 1, secondEigenvalue) &&
                         registerComputation("farthest_eigenvalue", 0, farthestEigenvalue);

}  // namespace
}  // namespace fpc::papers
