// Steady states as one input or parameter varies: every branch that a scan of starts meets, traced
// round its folds, with the points where the number or the stability of steady states changes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/closed_loop.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// Writes f(x, p); a steady state is f = 0. May throw; a branch ends there.
using ParametricField = std::function<void(VectorRef x, double parameter, Eigen::Ref<Vector> f)>;
/// The matrix whose eigenvalues decide on the stability of a steady state.
using Linearisation = std::function<Matrix(VectorRef x, double parameter)>;

struct ContinuationProblem {
  ParametricField field;
  Linearisation linearisation;  ///< empty: the Jacobian of field
  bool map{false};  ///< eigenvalues are those of a map: stable inside the unit circle, else Re < 0
};

struct ContinuationParams {
  double lower{}, upper{};          ///< of the parameter
  Vector state_lower, state_upper;  ///< n_x, where starts are scanned
  Vector state_size;                ///< n_x, typical sizes > 0: arc length is counted in them
  double parameter_size{0.0};       ///< 0: a tenth of the range
  Matrix starts;                    ///< n_x n, besides the scanned ones; may be empty
  int scanned_starts{40};           ///< per parameter value, low-discrepancy (halton1960)
  int scanned_parameters{5};        ///< values, ends included
  double step_max{0.05};            ///< arc length per step, in sizes
  double step_min{1e-7};
  int max_points{20000};                  ///< per branch
  void validate(Eigen::Index n_x) const;  ///< @throws InputError naming the field
};

struct BranchPoint {
  double parameter{};
  Vector state;
  Eigenvalues values;
  int unstable{};  ///< eigenvalues outside the stable region
  bool stable() const { return unstable == 0; }
};

enum class SpecialKind {
  kFold,          ///< two steady states meet
  kHopf,          ///< a complex pair crosses: oscillation (of a map: Neimark-Sacker)
  kFlip,          ///< of a map: an eigenvalue crosses -1
  kTurningPoint,  ///< a state has an extreme over the parameter, its gain changes sign
};
const std::string& name(SpecialKind kind);  ///< "fold", "hopf", "flip", "turning point"

struct SpecialPoint {
  SpecialKind kind{};
  double parameter{};
  Vector state;
  Eigen::Index turning_state{-1};   ///< of a turning point
  std::complex<double> eigenvalue;  ///< of a Hopf point or flip: the one that crosses
};

struct Branch {
  std::vector<BranchPoint> points;
  std::vector<SpecialPoint> special;  ///< in the order of the branch
  bool closed{false};                 ///< ends where it began
};

/// Pseudo-arclength continuation (keller1977): tangent predictor, Newton on f = 0 and the
/// hyperplane across the tangent, in scaled variables. Folds and turning points are sign changes of
/// a component of the tangent, Hopf points and flips a change in the number of unstable
/// eigenvalues; all are refined by bisection of the arc length. Nothing is told where they are.
/// Source: kuznetsov2004, sections 10.1-10.2.
/// @throws InputError if params do not fit.
std::vector<Branch> continueBranches(const ContinuationProblem& problem,
                                     const ContinuationParams& params,
                                     const std::function<void(int branches)>& progress = {});

/// Steady states at one parameter value from the same scan, without the branches between them.
std::vector<BranchPoint> steadyStatesAt(const ContinuationProblem& problem,
                                        const ContinuationParams& params, double parameter);

}  // namespace fpc
