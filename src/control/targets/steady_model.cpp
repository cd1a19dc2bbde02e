#include "control/targets/steady_model.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kIntegrates = 1e-9;  // own coefficients that add up to 1
constexpr double kSame = 1e-10;       // of the largest entry
constexpr double kNoRest = 1e-12;     // a pivot of I - df/dy

bool integrates(const OutputModel& submodel, int output) {
  return std::all_of(submodel.rules.begin(), submodel.rules.end(), [&](const Rule& rule) {
    double sum = 0.0;
    for (std::size_t i = 0; i < submodel.regressors.size(); ++i) {
      const Regressor& r = submodel.regressors[i];
      if (r.kind == SignalKind::kOutput && r.index == output)
        sum += rule.coefficients[static_cast<Index>(i)];
    }
    return std::abs(sum - 1.0) <= kIntegrates;
  });
}

template <typename T>
bool same(const T& a, const T& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSame * (1.0 + a.cwiseAbs().maxCoeff());
}

}  // namespace

SteadyModel::SteadyModel(const TsModel& model, const std::vector<bool>& integrating)
    : local_(model) {
  const Index n_y = countOf(model.outputs), n_u = countOf(model.inputs);
  for (Index i = 0; i < n_y; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool level = integrating[k] || integrates(model.submodels[k], static_cast<int>(i));
    (level ? levels_ : others_).push_back(i);
    output_lags_.push_back(std::max(model.maxLag(SignalKind::kOutput, static_cast<int>(i)) + 1, 1));
  }
  for (Index j = 0; j < n_u; ++j)
    input_lags_.push_back(std::max(model.maxLag(SignalKind::kInput, static_cast<int>(j)), 1));
  const Index n_x = local_.stateSize(), n_w = countOf(levels_), n_r = countOf(others_);
  state_ = next_ = Vector::Zero(n_x);
  slopes_A_ = Matrix::Zero(n_x, n_x);
  slopes_B_ = Matrix::Zero(n_x, n_u);
  own_ = old_own_ = Matrix::Zero(n_y, n_y);
  input_ = old_input_ = Matrix::Zero(n_y, n_u);
  constant_ = old_constant_ = Vector::Zero(n_y);
  regular_ = Matrix::Zero(n_r, n_r);
  right_ = solved_ = Matrix::Zero(n_r, n_u + n_w + 1);
  column_ = Vector::Zero(n_r);
  if (n_r > 0) factors_ = Eigen::FullPivLU<Matrix>(n_r, n_r);
  gain_ = Matrix::Zero(n_y, n_u + n_w);
  offset_ = Vector::Zero(n_y);
  balance_ = Matrix::Zero(n_w, n_u + n_w);
  imbalance_ = Vector::Zero(n_w);
}

void SteadyModel::derive(VectorRef y, VectorRef u, VectorRef d, VectorRef w) {
  local_.restState(y, u, d, state_);
  local_.blend(state_, u, d);
  const AffineModel& m = local_.affine();
  slopes_A_ = m.A;
  slopes_B_ = m.B;
  local_.addSlopes(state_, u, d, slopes_A_, slopes_B_);
  next_ = m.g;
  next_ += m.A.lazyProduct(state_);
  next_ += m.B.lazyProduct(u);
  for (Index i = 0; i < y.size(); ++i) {
    const Index row = local_.outputState(i);
    for (Index j = 0; j < y.size(); ++j) {
      double sum = 0.0;
      for (int lag = 0; lag < output_lags_[static_cast<std::size_t>(j)]; ++lag)
        sum += slopes_A_(row, local_.outputState(j, lag));
      own_(i, j) = (i == j ? 1.0 : 0.0) - sum;
    }
    for (Index j = 0; j < u.size(); ++j) {
      double sum = slopes_B_(row, j);
      for (int lag = 1; lag <= input_lags_[static_cast<std::size_t>(j)]; ++lag)
        sum += slopes_A_(row, local_.inputState(j, lag));
      input_(i, j) = sum;
    }
    constant_[i] = next_[row] + w[i] - y[i];
  }
  constant_ += own_.lazyProduct(y);
  constant_ -= input_.lazyProduct(u);
}

/// By hand: FullPivLU::solve allocates.
void SteadyModel::solveOthers() {
  const auto& rows = factors_.permutationP().indices();
  const auto& columns = factors_.permutationQ().indices();
  for (Index c = 0; c < right_.cols(); ++c) {
    for (Index i = 0; i < rows.size(); ++i) column_[rows[i]] = right_(i, c);
    factors_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(column_);
    factors_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(column_);
    for (Index i = 0; i < columns.size(); ++i) solved_(columns[i], c) = column_[i];
  }
}

bool SteadyModel::linearise(VectorRef y, VectorRef u, VectorRef d, VectorRef w, VectorRef held) {
  old_own_.swap(own_);
  old_input_.swap(input_);
  old_constant_.swap(constant_);
  derive(y, u, d, w);
  settled_ = own_.allFinite() && input_.allFinite() && constant_.allFinite();
  if (!settled_) return false;
  settled_ = same(own_, old_own_) && same(input_, old_input_) && same(constant_, old_constant_);

  const Index n_u = u.size(), n_w = countOf(levels_), n_r = countOf(others_);
  for (Index i = 0; i < n_r; ++i) {
    const Index row = others_[static_cast<std::size_t>(i)];
    for (Index j = 0; j < n_r; ++j)
      regular_(i, j) = own_(row, others_[static_cast<std::size_t>(j)]);
    right_.row(i).head(n_u) = input_.row(row);
    for (Index j = 0; j < n_w; ++j)
      right_(i, n_u + j) = -own_(row, levels_[static_cast<std::size_t>(j)]);
    right_(i, n_u + n_w) = constant_[row];
  }
  if (n_r > 0) {
    factors_.compute(regular_);
    if (factors_.matrixLU().diagonal().cwiseAbs().minCoeff() <= kNoRest) return false;
    solveOthers();
  }
  gain_.setZero();
  offset_.setZero();
  for (Index i = 0; i < n_r; ++i) {
    gain_.row(others_[static_cast<std::size_t>(i)]) = solved_.row(i).head(n_u + n_w);
    offset_[others_[static_cast<std::size_t>(i)]] = solved_(i, n_u + n_w);
  }
  for (Index j = 0; j < n_w; ++j) gain_(levels_[static_cast<std::size_t>(j)], n_u + j) = 1.0;
  for (Index i = 0; i < n_w; ++i) {
    const Index row = levels_[static_cast<std::size_t>(i)];
    balance_.row(i).setZero();
    balance_.row(i).head(n_u) = input_.row(row);
    imbalance_[i] = constant_[row] - own_(row, row) * held[row];
    for (Index j = 0; j < y.size(); ++j) {
      if (j == row) continue;
      balance_.row(i) -= own_(row, j) * gain_.row(j);
      imbalance_[i] -= own_(row, j) * offset_[j];
    }
  }
  return gain_.allFinite() && offset_.allFinite() && balance_.allFinite();
}

}  // namespace fpc
