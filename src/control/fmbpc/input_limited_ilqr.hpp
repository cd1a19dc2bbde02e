// Iterative LQR with input limits: the inputs of a whole horizon along the nonlinear path of the
// fuzzy model.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

struct IlqrParams {
  int horizon_steps{40};  ///< N
  int iterations{8};      ///< most linearisations per sample
  Vector weight_output;   ///< n_y, diagonal W
  Vector weight_move;     ///< n_u, diagonal L
  Vector weight_input;    ///< n_u, diagonal R; empty: 0
  Vector input_target;    ///< n_u, u_t; with weight_input
};

/// Minimises  sum_{i=1..N} |y(k+i) - y_r(k+i)|^2_W + sum_{i<N} |u(k+i) - u(k+i-1)|^2_L
/// + |u(k+i) - u_t|^2_R  over inputs
/// inside their limits, with the rules blended anew at every predicted sample: Gauss-Newton steps
/// by a Riccati sweep backwards and a simulation of the model forwards, from the plan of the sample
/// before. An input at a bound stays there, one at its move limit goes where u(k+i-1) goes; the
/// others are found again.
/// Source: li2004; bounds after tassa2014. Work is linear in N
/// and bounded by `iterations`. No allocation after construction. The matrices of a linear model's
/// sweep are kept: they are found again only before a sample at which other inputs are at a limit.
class InputLimitedIlqr {
 public:
  InputLimitedIlqr(const LocalModel& model, IlqrParams params, InputLimits limits);
  void forget();  ///< the next plan starts from the input held
  /// n_u, where the inputs of the next plans are to rest.
  void aimInputs(VectorRef input_target) { params_.input_target = input_target; }
  /// From the next plan on; the horizon stays.
  void retune(int iterations, VectorRef weight_output, VectorRef weight_move,
              VectorRef weight_input, VectorRef input_target);
  /// From the next plan on only the errors of x(k+1)..x(k+n) count, 0 <= n <= N; at first all.
  void countErrors(Eigen::Index n);
  bool warm() const { return warm_; }  ///< the next plan goes on from the last one
  /// state xi(k), correction n_x (added to every prediction), offset_output n_y (y - y_m),
  /// disturbances n_d N, reference n_y N or more columns. Returns false if nothing finite came out.
  bool plan(VectorRef state, VectorRef correction, VectorRef offset_output,
            const Matrix& disturbances, const Matrix& reference, VectorRef input_previous);
  const Matrix& inputs() const { return inputs_; }              ///< n_u N, u(k)...
  const Matrix& states() const { return states_; }              ///< n_x N + 1, xi(k)...
  const Matrix& disturbances() const { return disturbances_; }  ///< n_d N, as they are expected
  double cost() const { return cost_; }                         ///< of that plan
  long evaluations() const { return evaluations_; }             ///< of the rules, for that plan

 private:
  enum class Bound { kFree, kFixed, kMoves };  ///< an input: at a limit; at its move limit

  void evaluate(Eigen::Index i);
  double simulate(double share, bool feedback, Matrix& states, Matrix& inputs);
  void linearise();
  bool sweep();
  void reach(Eigen::Index i);
  void goBack(Eigen::Index i);
  void findPattern();
  void narrowPattern(const Matrix& A);
  void findChains();
  void multiplyByA(const Matrix& A);
  void slopesOfStates(const Matrix& A);
  double rowTimes(const Matrix& A, Eigen::Index row, const Vector& x) const;
  bool chooseInput(Eigen::Index i);
  bool findFeedback(Eigen::Index i);
  bool atMoveLimit(Eigen::Index i, Eigen::Index a) const;
  bool solveFree();
  bool fixMore();
  bool release();
  double weigh(Eigen::Index i, const Matrix& states, const Matrix& inputs) const;

  LocalModel model_;
  IlqrParams params_;
  InputLimits limits_;
  Eigen::Index n_x_, n_u_, n_y_, N_, counted_{N_};
  bool warm_{false};
  double cost_{};
  long evaluations_{};
  Matrix states_, inputs_, trial_states_, trial_inputs_, step_;  ///< columns: samples
  std::vector<Matrix> A_, B_, K_;                                ///< one per sample
  struct Stage {                                                 ///< of the last sweep
    Matrix P, Quu, Qux;
    std::vector<Bound> bounds;  ///< n_u
  };
  std::vector<Stage> stages_;  ///< N of a linear model, else none
  bool linear_, linearised_{false}, swept_{false};
  /// Of each column of A the rows that may not be 0, of each row the columns.
  std::vector<std::vector<Eigen::Index>> rows_, columns_;
  struct Chain {
    Eigen::Index first, length;
  };
  std::vector<Chain> chains_;   ///< of a linear model, else none
  std::vector<bool> in_chain_;  ///< n_x
  Matrix P_, PA_, PB_, KT_, Quu_, Qux_, Qxx_, free_Quu_;
  Vector p_, Qu_, Qx_, wish_, state_, next_, moved_, lower_, upper_, input_, correction_, offset_;
  Matrix disturbances_, reference_;
  std::vector<bool> fixed_;
  std::vector<Bound> bounds_;  ///< n_u, of the sample at work
  Eigen::LLT<Matrix> factor_;
};

}  // namespace fpc
