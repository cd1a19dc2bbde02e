#include "identification/auto_knowledge.hpp"

#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "base/decompositions.hpp"
#include "identification/knowledge_map.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kRestSteps = 3000;

/// Slower poles by one factor in every rule whose poles lie outside the known radius.
void shrinkRules(const RecurrentShape& shape, double radius, Vector& p) {
  const Index n = shape.states;
  for (Index i = 0; i < shape.rules; ++i) {
    Matrix companion = Matrix::Zero(n, n);
    companion.diagonal(-1).setOnes();
    companion.row(0) = p.segment(shape.at(i, 0), n).transpose();
    const double largest = eigenOf(companion).eigenvalues().cwiseAbs().maxCoeff();
    if (!(largest > radius)) continue;
    for (Index j = 0; j < n; ++j)
      p[shape.at(i, 0) + j] *= std::pow(0.999 * radius / largest, static_cast<double>(j + 1));
  }
}

/// Companion form: linear rows by the quadratic programme, high orders by their poles.
class RegressorAdmission {
 public:
  RegressorAdmission(const AutoData& data, const Fitted& fitted) : data_(data), fitted_(fitted) {}

  bool operator()(const Matrix& metric, Vector& unknowns) {
    const RecurrentShape& shape = fitted_.shape;
    const Index n = shape.linearCount();
    fitted_.parameters = unknowns.head(shape.parameterCount());
    if (first_ && data_.known.max_pole > 0.0)
      shrinkRules(shape, data_.known.max_pole, fitted_.parameters);
    first_ = false;
    const KnowledgeRows rows = inParameters(
        knowledgeRows(toSubmodel(data_, fitted_), data_.output, *data_.data, data_.known), n,
        [this, n](const Vector& linear) {
          Fitted other = fitted_;
          other.parameters.head(n) = linear;
          return stackedConsequents(toSubmodel(data_, other).rules);
        });
    Vector theta = fitted_.parameters.head(n);
    const Matrix H = metric.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
    if (!nearestInside(rows, H, theta)) return false;
    unknowns.head(n) = fitted_.parameters.head(n) = theta;
    return keepsPoles(toSubmodel(data_, fitted_), data_.output, data_.known);
  }

 private:
  const AutoData& data_;
  Fitted fitted_;
  bool first_{true};
};

int signOf(const PriorKnowledge& known, Index cause) {
  const auto at = static_cast<std::size_t>(cause);
  if (at < known.monotone.size() && known.monotone[at] != 0) return known.monotone[at];
  return at < known.gain.size() ? known.gain[at] : 0;
}

/// Hidden states: every rule's poles and gains.
bool ruleAgrees(const AutoData& data, const Fitted& fitted, const Vector& p, Index rule) {
  const RecurrentShape& shape = fitted.shape;
  const Index n = shape.states, m = shape.exogenous;
  Matrix A(n, n), B(n, m);
  for (Index r = 0; r < n; ++r) {
    A.row(r) = p.segment(shape.at(rule, r), n).transpose();
    B.row(r) = p.segment(shape.at(rule, r) + n, m).transpose();
  }
  const double largest = eigenOf(A).eigenvalues().cwiseAbs().maxCoeff();
  if (data.known.max_pole > 0.0 && !(largest <= data.known.max_pole)) return false;
  bool signs = false;
  for (Index j = 0; j < m; ++j) signs = signs || signOf(data.known, j) != 0;
  if (!signs) return true;
  if (!(largest < 1.0)) return false;
  const Matrix gains = (Matrix::Identity(n, n) - A).partialPivLu().solve(B);
  for (Index j = 0; j < m; ++j)
    if (signOf(data.known, j) != 0 && !(signOf(data.known, j) * gains(0, j) > 0.0)) return false;
  return true;
}

}  // namespace

std::function<bool(const Matrix&, Vector&)> admission(const AutoData& data, const Fitted& fitted) {
  if (data.known.empty()) return {};
  if (fitted.shape.companion) {
    auto admit = std::make_shared<RegressorAdmission>(data, fitted);
    return [admit](const Matrix& metric, Vector& unknowns) { return (*admit)(metric, unknowns); };
  }
  return [&data, fitted](const Matrix&, Vector& unknowns) {
    for (Index i = 0; i < fitted.shape.rules; ++i)
      if (!ruleAgrees(data, fitted, unknowns, i)) return false;
    return true;
  };
}

bool restsAsKnown(const AutoData& data, const Fitted& fitted) {
  const RecurrentShape& shape = fitted.shape;
  RecurrentStep step(shape);
  const double y_shift = shape.absolute ? 0.0 : data.shift[data.output];
  for (const auto& state : data.known.steady) {
    Vector v(shape.exogenous), x = fitted.prior.mean, next(shape.states);
    for (Index j = 0; j < v.size(); ++j) {
      const Regressor& r = fitted.exogenous[static_cast<std::size_t>(j)];
      const Index column = data.data->column(r.kind, r.index);
      v[j] = (state.values[column] - data.shift[column]) / data.scale[column];
    }
    for (int k = 0; k < kRestSteps; ++k) {
      step.predict(fitted.parameters, x, v, next);
      x = next.cwiseMax(fitted.prior.lower).cwiseMin(fitted.prior.upper);
    }
    const double rest = y_shift + data.scale[data.output] * shape.output(x[0]);
    if (!(std::abs(rest - state.values[data.output]) <= state.within)) return false;
  }
  return true;
}

}  // namespace fpc
