// The closed-loop paradigm: dual-mode predictive control whose free perturbations keep a base law
// inside constraints.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "optim/qp.hpp"

namespace fpc {

enum class ClpCostKind { kLeastPerturbation, kLq };
/// Input and move limits, or increments around the moving steady input as the paper has them.
enum class ClpBounds { kAbsolute, kIncremental };

inline std::vector<std::string> wordsOf(ClpCostKind) { return {"least_perturbation", "lq"}; }
inline std::vector<std::string> wordsOf(ClpBounds) { return {"absolute", "incremental"}; }

/// Section `clp` of a loop file.
struct ClpParams {
  int perturbation_steps{42};  ///< n_c, samples of mode 1
  ClpCostKind cost{ClpCostKind::kLeastPerturbation};
  Vector weight_perturbation;  ///< n_u, of |c|^2 (least_perturbation); default 1
  Vector weight_tracking;      ///< n_y, of |y - y_r|^2 (least_perturbation); default 0
  Vector weight_state_output;  ///< n_y, Q on the outputs' states (lq); default 1
  Vector weight_input;         ///< n_u, R (lq); default 1
  ClpBounds bounds{ClpBounds::kAbsolute};
  Vector increment_lower, increment_upper;  ///< n_u, around the moving steady input (incremental)
  std::vector<int> target_outputs;  ///< outputs that define the steady state (lq, incremental), as
                                    ///< many as inputs; default all of them where n_y = n_u
  Vector output_lower, output_upper;  ///< n_y, soft; infinite if absent. Finite ones give way to
                                      ///< those of a target layer (PredictiveAction)
  Vector output_weight;               ///< n_y, > 0, of output_penalty; default 1
  double output_penalty{1e4};         ///< weight of squared soft violations beside the scaled cost:
                                      ///< largest entry of H near 1, slacks over slack_scale
  QpSettings qp{2000};
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// The stacked problem of one sample, kept for tests and reports.
/// J(U) = cost_constant + 2 cost_scale (1/2 v'Hv + g'v) for slacks of zero, v = U / input_scale.
struct ClpProblem {
  Matrix state_from_input;         ///< (n_x n_c) (n_u n_c): X = state_free + state_from_input U
  Vector state_free;               ///< n_x n_c, columns x(k+1)..x(k+n_c) stacked
  Matrix perturbation_from_input;  ///< T, unit lower block triangular: c = T U + t
  Vector perturbation_free;        ///< t
  QpProblem qp;        ///< in v = (U / input_scale, slack / slack_scale), cost over cost_scale
  Vector input_scale;  ///< n_u, powers of two near the input range: scaling is exact
  Vector slack_scale;  ///< one per softly limited output
  double cost_scale{1.0};
  double cost_constant{};  ///< J(0)
};

/// Decides u(k) from a local model with its base law. Works in the inputs: input limits are plain
/// bounds. Without an active limit (least_perturbation, no tracking) the action equals the base law
/// exactly.
class ClosedLoopParadigm {
 public:
  ClosedLoopParadigm(ClpParams params, InputLimits limits, Eigen::Index n_x, Eigen::Index n_y,
                     Eigen::Index n_u);
  ~ClosedLoopParadigm();
  ClosedLoopParadigm(ClosedLoopParadigm&&) noexcept;

  void reset();  ///< forgets the warm start
  /// Fills `action.input`, `action.source` and `report` (sizes kept: no allocation after the first
  /// call). If the QP fails, u = clip(u_base) and report.status says why; an input without a finite
  /// base is held. Feedforward and reference may have more than n_c columns. @throws InputError if
  /// other sizes have changed.
  void step(const PredictiveAction& now, ControlAction& action, SolverReport& report);
  const ClpProblem& problem() const;  ///< of the last step with consistent finite data
  const QpResult& solution() const;   ///< of the last step; without a QP the rolled-out base law
  const Vector& steadyState() const;  ///< x_ss of the last step (incremental)
  const Vector& steadyInput() const;  ///< u_ss of the last step (incremental)

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// P of Phi' P Phi - P + Phi' Q Phi + K' R K = 0, Phi = A - B K, for cost (12) of vallejo2021b,
/// (the sum already counts x(k+n_c)). By doubling; returns false if Phi is not stable.
bool terminalWeight(MatrixRef Phi, MatrixRef Q, MatrixRef KRK, Matrix& P);

}  // namespace fpc
