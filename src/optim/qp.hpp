// Dense convex quadratic programmes of the size a controller meets, solved by a dual active-set
// method (goldfarb1983) with warm start and no allocation after construction; inside
// proximal-point iterations (rockafellar1976) where the Hessian is only semidefinite.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// min 1/2 x'Hx + g'x  subject to  x_lower <= x <= x_upper,  a_lower <= A x <= a_upper.
/// Infinite bounds are absent; equal bounds are equalities.
/// Symbols: H n n symmetric positive semidefinite, A m n
struct QpProblem {
  Matrix H;
  Vector g;
  Vector x_lower, x_upper;
  Matrix A;
  Vector a_lower, a_upper;

  QpProblem() = default;
  /// H = I, g = 0, A = 0, all bounds infinite.
  QpProblem(Eigen::Index n, Eigen::Index m);
};

struct QpSettings {
  int max_iterations{10000};
  double feasibility_tolerance{1e-10};  ///< relative to |limit| + sum_j |a_j| (s_j + |x_j|)
  void validate() const;                ///< @throws InputError naming the field
};

/// Multipliers: stationarity is H x + g = y_x + A' y_a, where y >= 0 on an active lower bound and
/// <= 0 on an upper one. After kInfeasible they are a Farkas certificate: see farkasRadius().
struct QpResult {
  SolveStatus status{SolveStatus::kNumericalError};
  Vector x;               ///< n, meaningless unless usable(); exactly at the active bounds
  Vector y_x;             ///< n, multipliers of the bounds
  Vector y_a;             ///< m, multipliers of the rows
  int iterations{};       ///< working sets tried
  int active{};           ///< number of active constraints
  double kkt_residual{};  ///< the largest of scaled stationarity, feasibility, sign and
                          ///< complementarity errors
  bool usable() const { return status == SolveStatus::kSolved; }
};

/// The size s_j of unknown j is that of its box, or the median of what each row and the cost say of
/// it alone, |limit_i / a_ij| and |g_j / H_jj|, whichever is less: a power of two, 1 from 2^-7 on
/// (never more: no tolerance grows by a guess). Residual, radius and tolerance are those of the
/// problem in x_j / s_j.

/// Scaled KKT residual of a point (independent of how it was found): stationarity relative to
/// 1 + its largest term, feasibility to |limit| + sum_j |a_j| (s_j + |x_j|), complementarity
/// min(multiplier, distance to the limit), both scaled. A violation within the rounding (1e-14) of
/// the largest coefficient of A is none in a row that has no larger coefficients itself. Infinite
/// if anything is not finite.
/// @throws InputError if the sizes of x, y_x, y_a are not those of the problem
double kktResidual(const QpProblem& problem, VectorRef x, VectorRef y_x, VectorRef y_a);

/// How much a Farkas certificate proves. With y_x + A'y_a = 0 any x inside all limits would give
/// 0 = y_x'x + y_a'Ax >= sum y+ lower + sum y- upper, so a positive right side proves that there is
/// none. @return r such that no x with |x_j| <= r s_j for all j is inside all limits, rounding
/// counted against the certificate: right side / sum_j s_j |y_x + A'y_a|_j; infinite if that is
/// exactly zero, 0 if nothing is proven
/// @throws InputError if the sizes of y_x and y_a are not those of the problem
double farkasRadius(const QpProblem& problem, VectorRef y_x, VectorRef y_a);

class QpSolver {
 public:
  /// Room for problems up to n unknowns and m rows; solve() does not allocate for these sizes, nor
  /// for smaller ones unless the size differs from the solve before.
  /// @throws InputError if n < 1, m < 0 or the settings are not valid
  QpSolver(Eigen::Index n, Eigen::Index m, const QpSettings& settings = {});
  ~QpSolver();
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;

  /// Solves; with warm = true starts from the active set of the previous solve of the same size.
  /// Non-finite or wrongly sized data, or lower > upper, give kInvalidProblem; an H that is not
  /// positive semidefinite, or a cost without a minimum, kNumericalError; never throws. kSolved
  /// implies kkt_residual <= 1e-9 (or 10 feasibility_tolerance if that is larger), kInfeasible a
  /// certificate in y_x and y_a with farkasRadius() >= 100 (and 100 |x| of the point that it was
  /// found at). Where H is semidefinite and the minimum not unique, x is one of them. The factors
  /// of H are kept while H stays bitwise the same.
  const QpResult& solve(const QpProblem& problem, bool warm = true);
  void forget();  ///< the next solve is cold

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace fpc
