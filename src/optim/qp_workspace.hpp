// Private parts of the QP solver: the equality-constrained KKT system of one working set (used to
// try a working set and to polish the answer), the dual active-set method (goldfarb1983,
// section 4) that finds the set, and the proximal-point method around both for Hessians that
// are only semidefinite.
#pragma once

#include <cstddef>
#include <vector>

#include "optim/qp.hpp"

namespace fpc::qp {

using Index = Eigen::Index;

inline std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Which limit of a constraint is in the working set. Constraint i < n is the bound of x_i, n + j
/// is row j.
enum Side : signed char { kUpper = -1, kOff = 0, kLower = 1 };
using Sides = std::vector<Side>;

inline double lowerOf(const QpProblem& p, Index id) {
  return id < p.g.size() ? p.x_lower(id) : p.a_lower(id - p.g.size());
}
inline double upperOf(const QpProblem& p, Index id) {
  return id < p.g.size() ? p.x_upper(id) : p.a_upper(id - p.g.size());
}
inline bool isEquality(const QpProblem& p, Index id) { return lowerOf(p, id) == upperOf(p, id); }
inline double limitOf(const QpProblem& p, Index id, Side side) {
  return side == kUpper ? upperOf(p, id) : lowerOf(p, id);
}

/// Sine of the angle to the working set below which a constraint counts as dependent: where other
/// constraints can be taken first, and where it is this one or none.
constexpr double kNearlyDependent = 1e-4;
constexpr double kDependent = 1e-10;

/// What an error in constraint id is measured against: |limit| + sum_j |a_j| (1 + |x_j|).
double feasibilityScale(const QpProblem& p, Index id, VectorRef x, double limit);

/// Rows whose coefficients are rounding of numbers as large as the largest coefficient
/// (0 x <= -2.8e-17) say nothing: a violation below the rounding is none.
class RowNoise {
 public:
  void resize(Index m) { sum_.setZero(m); }
  void reset() { largest_ = largest_sum_ = -1.0; }  ///< for another problem
  bool covers(const QpProblem& p, Index id, double violation, VectorRef x);
  /// Whether a violation is within tolerance * feasibilityScale(). @param x_largest of |x|
  bool within(const QpProblem& p, Index id, double violation, double tolerance, VectorRef x,
              double x_largest, double limit);

 private:
  double rounding(const QpProblem& p);
  double rowSum(const QpProblem& p, Index row);  ///< sum_j |a_j|

  double largest_{-1.0}, largest_sum_{-1.0};  // |a_ij| and row sum, negative while unknown
  Vector sum_;
};

/// max(1 + the terms of stationarity): what an error in the gradient is measured against.
double gradientScale(const QpProblem& p, VectorRef Hx, VectorRef y_x, VectorRef Aty);

/// kktResidual() for products that are known already.
double scaledResidual(const QpProblem& p, RowNoise& noise, VectorRef x, VectorRef y_x,
                      VectorRef y_a, VectorRef Hx, VectorRef Aty, VectorRef Ax);

/// min 1/2 x'Hx + g'x with the constraints of a working set as equalities. Active bounds only
/// remove their unknowns; the rest is L L' = H_ff + shift and Q R = L^-1 A_wf'. Factors are kept as
/// long as H and the working set stay the same. The shift is zero unless H is only semidefinite: it
/// is in the factors alone, so that the refinement of solve() is a proximal-point iteration on the
/// problem as it was given.
class KktSystem {
 public:
  void resize(Index n, Index m);
  /// Forgets factors and shift unless H is bitwise the one before.
  void setHessian(const Matrix& H);
  /// Sets the shift that equilibrates H and A. @return false if H is not positive semidefinite
  bool regularise(const QpProblem& p);
  /// Divides the shift by that; @return false, and nothing is changed, if it is at its least
  bool reduceShift(double factor);
  bool shifted() const { return shift_size_ > 0.0; }
  const Vector& shift() const { return shift_; }
  /// @return false if H_ff is not positive definite or the rows are dependent, that is a row's sine
  /// of the angle to the rows before is not above the tolerance
  bool factor(const QpProblem& p, const Sides& sides, double dependent_tolerance);
  bool factorFree(const QpProblem& p, const Sides& sides);  ///< L only
  /// Extends L to all unknowns, free ones first. @return false if H is not positive definite
  bool complete();
  bool definite() const { return definite_; }  ///< the whole of H has been factored once
  bool diagonal() const { return diagonal_; }
  /// Iterative refinement from the x and y_a given; x is exactly at the active bounds. Needs
  /// factor().
  void solve(const QpProblem& p, const Sides& sides, QpResult& result);
  void evaluate(const QpProblem& p, const QpResult& result);  ///< sets hx() and aty() of any point
  const Vector& hx() const { return hx_; }
  const Vector& aty() const { return aty_; }
  const Matrix& cholesky() const { return L_; }  ///< in the order of order(), after complete()
  const std::vector<Index>& order() const { return order_; }
  Index freeCount() const { return n_free_; }

 private:
  bool cholesky(Index column_begin, Index column_end, Index row_begin, Index row_end);
  bool choleskyOfFree();
  void transformRows();
  void applyHessian(const QpProblem& p, const Vector& x);
  bool gatherRows(const QpProblem& p, const Sides& sides);
  bool factorRows(double dependent_tolerance);
  bool residual(const QpProblem& p, QpResult& result);
  void correct(QpResult& result);

  void equilibrate(const QpProblem& p);
  void forgetFactors();

  Matrix H_, L_;
  Vector shift_, row_scale_, row_largest_, least_pivot_;
  double shift_size_{};       // of the shift, relative to the equilibrated problem
  std::vector<Index> order_;  // free unknowns, then fixed ones, each ascending
  std::vector<char> fixed_;
  std::vector<Index> rows_;  // of A, in the working set
  std::vector<Side> row_side_;
  Index n_free_{}, n_rows_{};
  bool factored_{}, rows_factored_{}, complete_{}, definite_{};
  bool diagonal_{};  // H
  Matrix At_;        // n n_rows, the working rows as columns
  Matrix Vt_, Q_, R_;
  Vector y_, hx_, aty_, residual_free_, residual_row_, work_, work_row_, norm_;
};

/// The dual method. Between iterations x minimises the cost on the working set and every multiplier
/// has its sign. J = L^-T times a rotation; J'N = [R; 0], N the normals of the working set, first
/// column first (their sections 3, 4).
class DualActiveSet {
 public:
  void resize(Index n, Index m);
  /// Starts from a working set with the cost of p but the gradient g; dependent rows and
  /// constraints with multipliers of the wrong sign leave it.
  /// @return false if H plus shift is not positive definite
  bool start(const QpProblem& p, const Vector& g, KktSystem& kkt, Sides& sides);
  /// The same for another gradient, from the factors and the working set as they are.
  bool restart(const QpProblem& p, const Vector& g, Sides& sides);
  /// @return kSolved, kInfeasible (with a certificate), kIterationLimit or kNumericalError
  SolveStatus run(const QpProblem& p, const QpSettings& settings, double tolerance, RowNoise& noise,
                  Sides& sides, int& iterations);
  const Vector& x() const { return x_; }
  /// Iterative refinement of x() and the multipliers with J and R, on the data as given, for an H
  /// without a shift. Leaves them in the result, x exactly at the active bounds, and the products
  /// in kkt and Ax. @return whether the errors are down to rounding
  bool refine(const QpProblem& p, KktSystem& kkt, QpResult& result, Vector& Ax);
  void multipliers(Index n, QpResult& result) const;
  Index culprit() const {
    return culprit_;
  }  ///< the constraint that could not be satisfied, after kInfeasible
  void certificate(QpResult& result) const;  ///< after kInfeasible, as multipliers

 private:
  Index mostViolated(const QpProblem& p, double tolerance, RowNoise& noise, const Sides& sides,
                     Side& side);
  SolveStatus add(const QpProblem& p, const QpSettings& settings, RowNoise& noise, Index id,
                  Side side, Sides& sides, int& iterations);
  SolveStatus contradiction(const QpProblem& p, Index id, Side side);
  void combineActive();
  bool refineErrors(const QpProblem& p, const KktSystem& kkt, QpResult& result, const Vector& Ax);
  void refineStep(QpResult& result);
  void absorbIntoBounds(const QpProblem& p);
  void seed(const QpProblem& p, const KktSystem& kkt, const Sides& sides);
  void setNormal(const QpProblem& p, Index id, Side side);
  void transformNormal(Index id, Side side);
  bool dependent(double tolerance) const;
  Index blocking(const QpProblem& p, bool dependent, double& step) const;
  void append(Index id, Side side);
  void remove(Index k, Sides& sides);
  void minimise(const QpProblem& p, const Vector& g);
  void dropWrongSigns(const QpProblem& p, const Vector& g, Sides& sides);
  void measureRows(const QpProblem& p);

  Matrix J_, R_;
  std::vector<Index> active_;
  std::vector<Side> active_side_;
  std::vector<char> ignored_;  // redundant but for rounding
  Index q_{}, culprit_{-1};
  Vector x_, u_, normal_, d_, z_, r_, c_, ax_;
  Vector scale_;  // sqrt(H_ii)
  Vector error_;  // of the gradient
  Vector inverse_scale_;
  Vector row_metric_;  // 1 / the norm of a row in the metric diag(H)^-1
  bool rows_measured_{};
  Vector proof_x_, proof_a_, proof_error_;  // Farkas certificate and A'y_a + y_x of it
};

}  // namespace fpc::qp
