#include "control/fuzzy_lq/quadratic_law.hpp"

#include <Eigen/Cholesky>

#include "base/require_numbers.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSingular = 1e-12;    // relative size below which a pivot counts as rounding
constexpr double kHardlyBegun = 0.1;   // of the effect one sample later
constexpr int kLongestHorizon = 1000;  // samples

/// y(k+j) = F(j) x + T(j) g + S(j) u for an input that stays, j = 1..P; rows stacked.
struct Responses {
  Responses(const AffineModel& m, int P)
      : n_y(m.C.rows()), F(n_y * P, m.A.cols()), T(F.rows(), F.cols()), S(F.rows(), m.B.cols()) {
    Matrix free = m.C, sum = Matrix::Zero(n_y, m.A.cols());
    for (int j = 0; j < P; ++j) {
      sum += free;
      free = (free * m.A).eval();
      F.middleRows(j * n_y, n_y) = free;
      T.middleRows(j * n_y, n_y) = sum;
    }
    S = T * m.B;
    later = (sum + free) * m.B;
  }
  Index n_y;
  Matrix F, T, S;
  Matrix later;  ///< S(P + 1)
};

/// Y = free response + G dU: block (j, l) is S(j - l).
Matrix moveMatrix(const Responses& r, int P, int M) {
  const Index n_u = r.S.cols();
  Matrix G = Matrix::Zero(r.n_y * P, n_u * M);
  for (Index l = 0; l < M; ++l)
    G.block(l * r.n_y, l * n_u, (P - l) * r.n_y, n_u) = r.S.topRows((P - l) * r.n_y);
  return G;
}

/// U = L dU + u(k-1): inputs from moves.
Matrix sumOfMoves(Index n_u, int M) {
  Matrix L = Matrix::Zero(n_u * M, n_u * M);
  for (Index row = 0; row < M; ++row)
    for (Index column = 0; column <= row; ++column)
      L.block(row * n_u, column * n_u, n_u, n_u).setIdentity();
  return L;
}

/// The first n_u rows of H^-1, or nothing if H is singular.
Matrix firstRowsOfInverse(const Matrix& H, Index n_u) {
  const Vector scale = H.diagonal().cwiseSqrt().cwiseInverse();
  if (!H.allFinite() || !scale.allFinite()) return {};
  const Matrix scaled = scale.asDiagonal() * H * scale.asDiagonal();
  const Eigen::LLT<Matrix> factor(scaled);
  if (factor.info() != Eigen::Success) return {};
  const double smallest = factor.matrixLLT().diagonal().minCoeff();
  if (!(smallest * smallest > kSingular)) return {};
  const Matrix columns = factor.solve(Matrix::Identity(H.rows(), n_u));
  return (scale.asDiagonal() * columns * scale.head(n_u).asDiagonal()).transpose();
}

bool isShortSighted(const Responses& r, const Vector& weight_output) {
  const auto size = [&](const auto& effect) {
    return (weight_output.cwiseSqrt().asDiagonal() * effect).colwise().norm().eval();
  };
  const Eigen::RowVectorXd now = size(r.S.bottomRows(r.n_y)), later = size(r.later);
  return (now.array() <= kHardlyBegun * later.array()).any();
}

}  // namespace

void QuadraticWeights::validate(Index n_y, Index n_u, const std::string& where) const {
  requireNonNegative(output, n_y, where + ".weight_output");
  requireNonNegative(move, n_u, where + ".weight_move");
  requireNonNegative(input, n_u, where + ".weight_input");
  require((output.array() > 0.0).any(), where + ".weight_output", "at least one number > 0");
}

QuadraticLaw makeQuadraticLaw(const AffineModel& model, const QuadraticHorizon& horizon,
                              const QuadraticWeights& weights) {
  const int P = horizon.prediction, M = horizon.moves;
  require(P >= 1 && P <= kLongestHorizon, "controller.horizon_steps", "an integer from 1 to 1000");
  require(M >= 1 && M <= P, "controller.move_steps", "an integer from 1 to horizon_steps");
  const Index n_u = model.B.cols();
  weights.validate(model.C.rows(), n_u, "controller");
  const Responses r(model, P);
  const Matrix G = moveMatrix(r, P, M), L = sumOfMoves(n_u, M);
  const Matrix GQ = G.transpose() * weights.output.replicate(P, 1).asDiagonal();
  const Matrix LR = L.transpose() * weights.input.replicate(M, 1).asDiagonal();
  Matrix H = GQ * G + LR * L;
  H.diagonal() += weights.move.replicate(M, 1);
  for (Index i = 0; !horizon.together && i < H.rows(); ++i)
    for (Index j = 0; j < H.cols(); ++j)
      if (i % n_u != j % n_u) H(i, j) = 0.0;

  QuadraticLaw law;
  law.short_sighted = isShortSighted(r, weights.output);
  const Matrix first = firstRowsOfInverse(H, n_u);
  law.reference = Matrix::Zero(n_u, GQ.cols());
  law.target = Matrix::Zero(n_u, n_u);
  if (first.size() > 0) {
    law.reference = first * GQ;
    law.target = first * LR * Matrix::Identity(n_u, n_u).replicate(M, 1);
  }
  law.K = law.reference * r.F;
  law.offset = law.reference * r.T;
  law.previous = Matrix::Identity(n_u, n_u) - law.reference * r.S - law.target;
  law.usable = first.size() > 0 && law.reference.allFinite() && law.K.allFinite() &&
               law.offset.allFinite() && law.previous.allFinite();
  return law;
}

}  // namespace fpc
