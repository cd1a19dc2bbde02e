#include "control/fmbpc/input_limited_ilqr.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fpc {
namespace {

constexpr double kEnough = 1e-4;    // relative gain below which another round is not worth it
constexpr double kSmallest = 0.05;  // share of a step below which it is given up

}  // namespace

InputLimitedIlqr::InputLimitedIlqr(const LocalModel& model, IlqrParams params, InputLimits limits)
    : model_(model),
      params_(std::move(params)),
      limits_(std::move(limits)),
      n_x_(model.stateSize()),
      n_u_(limits_.lower.size()),
      n_y_(params_.weight_output.size()),
      N_(params_.horizon_steps),
      states_(Matrix::Zero(n_x_, N_ + 1)),
      inputs_(Matrix::Zero(n_u_, N_)),
      trial_states_(states_),
      trial_inputs_(inputs_),
      step_(inputs_),
      A_(static_cast<std::size_t>(N_), Matrix::Zero(n_x_, n_x_)),
      B_(static_cast<std::size_t>(N_), Matrix::Zero(n_x_, n_u_)),
      K_(static_cast<std::size_t>(N_), Matrix::Zero(n_u_, n_x_)),
      linear_(std::all_of(model.model().submodels.begin(), model.model().submodels.end(),
                          [](const OutputModel& m) { return m.rules.size() == 1; })),
      in_chain_(static_cast<std::size_t>(n_x_)),
      P_(n_x_, n_x_),
      PA_(n_x_, n_x_),
      PB_(n_x_, n_u_),
      KT_(n_x_, n_u_),
      Quu_(n_u_, n_u_),
      Qux_(n_u_, n_x_),
      Qxx_(n_x_, n_x_),
      free_Quu_(n_u_, n_u_),
      p_(n_x_),
      Qu_(n_u_),
      Qx_(n_x_),
      wish_(n_u_),
      state_(n_x_),
      next_(n_x_),
      moved_(n_x_),
      lower_(n_u_),
      upper_(n_u_),
      input_(n_u_),
      correction_(n_x_),
      offset_(n_y_),
      disturbances_(model.model().disturbances.size(), N_),
      reference_(n_y_, N_),
      fixed_(static_cast<std::size_t>(n_u_)),
      bounds_(fixed_.size()),
      factor_(n_u_) {
  findPattern();
  chains_.reserve(in_chain_.size());
  if (linear_) stages_.assign(A_.size(), Stage{P_, Quu_, Qux_, bounds_});
}

/// The rules write the rows of the outputs; the others hand on what is past, once and for all.
void InputLimitedIlqr::findPattern() {
  const Matrix& A = model_.affine().A;
  std::vector<bool> ruled(static_cast<std::size_t>(n_x_));
  for (std::size_t o = 0; o < model_.model().outputs.size(); ++o)
    ruled[static_cast<std::size_t>(model_.outputState(static_cast<Eigen::Index>(o)))] = true;
  rows_.resize(static_cast<std::size_t>(n_x_));
  columns_.resize(rows_.size());
  for (Eigen::Index j = 0; j < n_x_; ++j)
    for (Eigen::Index k = 0; k < n_x_; ++k)
      if (ruled[static_cast<std::size_t>(k)] || A(k, j) != 0.0) {
        rows_[static_cast<std::size_t>(j)].push_back(k);
        columns_[static_cast<std::size_t>(k)].push_back(j);
      }
}

/// Of linear rules: what is 0 in A is so for ever, as are the inputs behind a dead time.
void InputLimitedIlqr::narrowPattern(const Matrix& A) {
  for (std::vector<Eigen::Index>& columns : columns_) columns.clear();
  for (Eigen::Index j = 0; j < n_x_; ++j) {
    std::vector<Eigen::Index>& rows = rows_[static_cast<std::size_t>(j)];
    rows.erase(
        std::remove_if(rows.begin(), rows.end(), [&](Eigen::Index k) { return A(k, j) == 0.0; }),
        rows.end());
    for (const Eigen::Index k : rows) columns_[static_cast<std::size_t>(k)].push_back(j);
  }
}

/// A row of A times x; what is 0 in A for ever is left out.
double InputLimitedIlqr::rowTimes(const Matrix& A, Eigen::Index row, const Vector& x) const {
  double sum = 0.0;
  for (const Eigen::Index j : columns_[static_cast<std::size_t>(row)]) sum += A(row, j) * x[j];
  return sum;
}

/// Stretches of states that only hand their value on to the next one, as those of a dead time.
void InputLimitedIlqr::findChains() {
  chains_.clear();
  for (Eigen::Index i = 0; i + 1 < n_x_; ++i) {
    const std::vector<Eigen::Index>& rows = rows_[static_cast<std::size_t>(i)];
    in_chain_[static_cast<std::size_t>(i)] =
        rows.size() == 1 && rows.front() == i + 1 && model_.affine().A(i + 1, i) == 1.0;
    if (!in_chain_[static_cast<std::size_t>(i)]) continue;
    if (chains_.empty() || chains_.back().first + chains_.back().length != i)
      chains_.push_back({i, 0});
    ++chains_.back().length;
  }
}

/// PA_ = P A and Qxx_ = A' P A; what is 0 in A for ever is left out.
void InputLimitedIlqr::multiplyByA(const Matrix& A) {
  for (const Chain& chain : chains_)
    PA_.middleCols(chain.first, chain.length) = P_.middleCols(chain.first + 1, chain.length);
  for (Eigen::Index j = 0; j < n_x_; ++j) {
    if (in_chain_[static_cast<std::size_t>(j)]) continue;
    PA_.col(j).setZero();
    for (const Eigen::Index k : rows_[static_cast<std::size_t>(j)])
      PA_.col(j) += A(k, j) * P_.col(k);
  }
  for (Eigen::Index j = 0; j < n_x_; ++j)
    for (const Chain& chain : chains_)
      Qxx_.col(j).segment(chain.first, chain.length) =
          PA_.col(j).segment(chain.first + 1, chain.length);
  for (Eigen::Index i = 0; i < n_x_; ++i) {
    if (in_chain_[static_cast<std::size_t>(i)]) continue;
    for (Eigen::Index j = 0; j < n_x_; ++j) {
      double sum = 0.0;
      for (const Eigen::Index k : rows_[static_cast<std::size_t>(i)]) sum += A(k, i) * PA_(k, j);
      Qxx_(i, j) = sum;
    }
  }
}

/// Qx_ = A' p. A sum of at most two terms has no order, so that the zeros need not be in it.
void InputLimitedIlqr::slopesOfStates(const Matrix& A) {
  for (Eigen::Index j = 0; j < n_x_; ++j) {
    const std::vector<Eigen::Index>& rows = rows_[static_cast<std::size_t>(j)];
    if (rows.size() > 2) {
      Qx_[j] = A.col(j).dot(p_);
      continue;
    }
    Qx_[j] = 0.0;
    for (const Eigen::Index k : rows) Qx_[j] += A(k, j) * p_[k];
  }
}

void InputLimitedIlqr::forget() { warm_ = false; }

void InputLimitedIlqr::countErrors(Eigen::Index n) {
  if (n != counted_) swept_ = false;
  counted_ = n;
}

void InputLimitedIlqr::retune(int iterations, VectorRef weight_output, VectorRef weight_move,
                              VectorRef weight_input, VectorRef input_target) {
  params_.iterations = iterations;
  params_.weight_output = weight_output;
  params_.weight_move = weight_move;
  params_.weight_input = weight_input;
  params_.input_target = input_target;
  swept_ = false;
}

/// What sample i+1 and the move of sample i cost.
double InputLimitedIlqr::weigh(Eigen::Index i, const Matrix& states, const Matrix& inputs) const {
  double cost = 0.0;
  for (Eigen::Index o = 0; o < n_y_ && i < counted_; ++o) {
    if (params_.weight_output[o] == 0.0) continue;
    const double error = states(model_.outputState(o), i + 1) + offset_[o] - reference_(o, i);
    cost += params_.weight_output[o] * error * error;
  }
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    const double move = inputs(a, i) - states(model_.inputState(a, 1), i);
    cost += params_.weight_move[a] * move * move;
  }
  for (Eigen::Index a = 0; a < params_.weight_input.size(); ++a) {
    const double distance = inputs(a, i) - params_.input_target[a];
    cost += params_.weight_input[a] * distance * distance;
  }
  return cost;
}

void InputLimitedIlqr::evaluate(Eigen::Index i) {
  model_.blend(state_, input_, disturbances_.col(i));
  ++evaluations_;
}

/// The model forwards under the plan's u, with feedback u + share * step + K (x - x of the plan),
/// clipped.
double InputLimitedIlqr::simulate(double share, bool feedback, Matrix& states, Matrix& inputs) {
  double cost = 0.0;
  states.col(0) = states_.col(0);
  for (Eigen::Index i = 0; i < N_; ++i) {
    input_ = inputs_.col(i);
    if (feedback) {
      moved_ = states.col(i) - states_.col(i);
      input_ += share * step_.col(i);
      input_ += K_[static_cast<std::size_t>(i)].lazyProduct(moved_);
    }
    for (Eigen::Index a = 0; a < n_u_; ++a) wish_[a] = states(model_.inputState(a, 1), i);
    limits_.clip(input_, wish_);
    inputs.col(i) = input_;
    state_ = states.col(i);
    evaluate(i);
    next_ = model_.affine().g + correction_;
    for (Eigen::Index k = 0; k < n_x_; ++k) moved_[k] = rowTimes(model_.affine().A, k, state_);
    next_ += moved_;
    next_ += model_.affine().B.lazyProduct(input_);
    states.col(i + 1) = next_;
    cost += weigh(i, states, inputs);
  }
  return cost;
}

/// The derivatives along the path: of the consequents, and of the weights that change with it.
void InputLimitedIlqr::linearise() {
  if (linear_ && linearised_) return;
  linearised_ = true;
  for (Eigen::Index i = 0; i < N_; ++i) {
    state_ = states_.col(i);
    input_ = inputs_.col(i);
    evaluate(i);
    A_[static_cast<std::size_t>(i)] = model_.affine().A;
    B_[static_cast<std::size_t>(i)] = model_.affine().B;
    model_.addSlopes(state_, input_, disturbances_.col(i), A_[static_cast<std::size_t>(i)],
                     B_[static_cast<std::size_t>(i)]);
  }
  if (!linear_) return;
  narrowPattern(A_.front());
  findChains();
}

/// P_ of sample i + 1 with what its errors cost, and Quu_, Qux_, Qxx_ of sample i.
void InputLimitedIlqr::reach(Eigen::Index i) {
  const Matrix& A = A_[static_cast<std::size_t>(i)];
  const Matrix& B = B_[static_cast<std::size_t>(i)];
  for (Eigen::Index o = 0; o < n_y_ && i < counted_; ++o) {
    const Eigen::Index row = model_.outputState(o);
    P_(row, row) += params_.weight_output[o];
  }
  multiplyByA(A);
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    PB_.col(a).setZero();
    for (Eigen::Index k = 0; k < n_x_; ++k)
      if (B(k, a) != 0.0) PB_.col(a) += B(k, a) * P_.col(k);
  }
  Qux_.noalias() = B.transpose().lazyProduct(PA_);
  Quu_.noalias() = B.transpose().lazyProduct(PB_);
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    const Eigen::Index before = model_.inputState(a, 1);
    const double L = params_.weight_move[a];
    Quu_(a, a) += L;
    Qux_(a, before) -= L;
    Qxx_(before, before) += L;
  }
  for (Eigen::Index a = 0; a < params_.weight_input.size(); ++a)
    Quu_(a, a) += params_.weight_input[a];
}

/// P_ of sample i: of the rest, P = Qxx + (K' Quu + Qux') K + K' Qux.
void InputLimitedIlqr::goBack(Eigen::Index i) {
  const Matrix& K = K_[static_cast<std::size_t>(i)];
  PB_.noalias() = K.transpose().lazyProduct(Quu_);
  PB_ += Qux_.transpose();
  KT_ = K.transpose();
  for (Eigen::Index j = 0; j < n_x_; ++j) {
    const auto addTo = [&](const Matrix& left, const Matrix& right) {
      moved_ = right(0, j) * left.col(0);
      for (Eigen::Index a = 1; a < n_u_; ++a) moved_ += right(a, j) * left.col(a);
      PA_.col(j) += moved_;
    };
    PA_.col(j) = Qxx_.col(j);
    addTo(PB_, K);
    addTo(KT_, Qux_);
  }
  P_ = 0.5 * (PA_ + PA_.transpose());
}

bool InputLimitedIlqr::sweep() {
  P_.setZero();
  p_.setZero();
  bool known = swept_;  // the matrices of this sample and those behind it
  swept_ = false;
  for (Eigen::Index i = N_ - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    if (known) {
      Quu_ = stages_[at].Quu;
      Qux_ = stages_[at].Qux;
    } else {
      reach(i);
    }
    for (Eigen::Index o = 0; o < n_y_ && i < counted_; ++o) {
      const Eigen::Index row = model_.outputState(o);
      p_[row] += params_.weight_output[o] * (states_(row, i + 1) + offset_[o] - reference_(o, i));
    }
    slopesOfStates(A_[at]);
    Qu_.noalias() = B_[at].transpose().lazyProduct(p_);
    for (Eigen::Index a = 0; a < n_u_; ++a) {
      const Eigen::Index before = model_.inputState(a, 1);
      const double moved = params_.weight_move[a] * (inputs_(a, i) - states_(before, i));
      Qu_[a] += moved;
      Qx_[before] -= moved;
    }
    for (Eigen::Index a = 0; a < params_.weight_input.size(); ++a)
      Qu_[a] += params_.weight_input[a] * (inputs_(a, i) - params_.input_target[a]);
    if (!chooseInput(i)) return false;
    if (known && bounds_ != stages_[at].bounds) {
      known = false;
      if (i + 1 < N_) P_ = stages_[at + 1].P;
      reach(i);
    }
    if (!known) {
      if (!findFeedback(i)) return false;
      goBack(i);
    }
    if (!known && linear_) {
      Stage& stage = stages_[at];
      stage.P = P_;
      stage.Quu = Quu_;
      stage.Qux = Qux_;
      stage.bounds = bounds_;
    }
    // Of the rest: p = Qx + K' (Quu k + Qu) + Qux' k.
    Qu_ += Quu_.lazyProduct(step_.col(i));
    p_ = Qx_ + K_[at].transpose().lazyProduct(Qu_);
    p_ += Qux_.transpose().lazyProduct(step_.col(i));
  }
  swept_ = linear_ && P_.allFinite();
  return P_.allFinite();
}

bool InputLimitedIlqr::plan(VectorRef state, VectorRef correction, VectorRef offset_output,
                            const Matrix& disturbances, const Matrix& reference,
                            VectorRef input_previous) {
  evaluations_ = 0;
  correction_ = correction;
  offset_ = offset_output;
  disturbances_ = disturbances.leftCols(N_);
  reference_ = reference.leftCols(N_);
  for (Eigen::Index i = 0; i + 1 < N_ && warm_; ++i) inputs_.col(i) = inputs_.col(i + 1);
  if (!warm_) inputs_.colwise() = Vector::Map(input_previous.data(), n_u_);
  states_.col(0) = state;
  cost_ = simulate(0.0, false, trial_states_, trial_inputs_);
  states_.swap(trial_states_);
  inputs_.swap(trial_inputs_);
  warm_ = std::isfinite(cost_);
  for (int n = 0; n < params_.iterations && warm_; ++n) {
    linearise();
    if (!sweep()) break;
    double share = 1.0, cost = simulate(share, true, trial_states_, trial_inputs_);
    while (!(cost < cost_) && share > kSmallest)
      cost = simulate(share *= 0.5, true, trial_states_, trial_inputs_);
    if (!(cost < cost_)) break;
    const bool enough = cost_ - cost < kEnough * cost_;
    cost_ = cost;
    states_.swap(trial_states_);
    inputs_.swap(trial_inputs_);
    if (enough) break;
  }
  return warm_;
}

}  // namespace fpc
