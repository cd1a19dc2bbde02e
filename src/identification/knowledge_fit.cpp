// The nearest model that agrees with what is known.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/data_set.hpp"
#include "identification/knowledge_map.hpp"
#include "identification/prior_knowledge.hpp"
#include "model/rule_poles.hpp"
#include "optim/qp.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFeasible = 1e-9;  // of a row's largest term
constexpr int kShrinks = 40;

void unstack(const Vector& theta, OutputModel& model) {
  const auto p = static_cast<Index>(model.regressors.size());
  for (std::size_t i = 0; i < model.rules.size(); ++i) {
    const Index at = static_cast<Index>(i) * (p + 1);
    model.rules[i].coefficients = theta.segment(at, p);
    model.rules[i].offset = theta[at + p];
  }
}

/// Sum over the record of w [x;1][x;1]' of each rule, block by block.
Matrix evidenceMetric(const Regression& rows, const OutputModel& model) {
  const Index p = rows.regressors.cols(), each = p + 1;
  const auto rules = static_cast<Index>(model.rules.size());
  Matrix H = Matrix::Zero(rules * each, rules * each);
  FiringResult firing;
  Vector x(each), z(rows.antecedents.cols());
  x[p] = 1.0;
  for (Index k = 0; k < rows.rows(); ++k) {
    z = rows.antecedents.row(k).transpose();
    x.head(p) = rows.regressors.row(k).transpose();
    firingWeights(model, z, firing);
    for (Index i = 0; i < rules; ++i)
      if (firing.weights[i] > 1e-9)
        H.block(i * each, i * each, each, each).noalias() += firing.weights[i] * x * x.transpose();
  }
  for (Index j = 0; j < H.rows(); ++j) H(j, j) += 1e-6 * (H(j, j) + 1e-9 * H.trace()) + 1e-12;
  return H;
}

/// Slower poles by the same factor, until all are inside.
void shrinkPoles(int output, const PriorKnowledge& known, OutputModel& model) {
  for (auto& rule : model.rules) {
    const auto poles = rulePoles(model, rule, static_cast<std::size_t>(output));
    if (poles.empty() || !(std::abs(poles.front()) > known.max_pole)) continue;
    const double factor = 0.999 * known.max_pole / std::abs(poles.front());
    for (std::size_t j = 0; j < model.regressors.size(); ++j) {
      const Regressor& r = model.regressors[j];
      if (r.kind == SignalKind::kOutput && r.index == output)
        rule.coefficients[static_cast<Index>(j)] *= std::pow(factor, r.lag + 1);
    }
  }
}

bool isInside(const KnowledgeRows& rows, const Vector& theta) {
  const Vector value = rows.A * theta;
  const Vector size = rows.A.cwiseAbs() * theta.cwiseAbs();
  for (Index i = 0; i < value.size(); ++i) {
    const double slack = kFeasible * (1e-3 + size[i]);
    if (value[i] < rows.lower[i] - slack || value[i] > rows.upper[i] + slack) return false;
  }
  return true;
}

}  // namespace

Vector stackedConsequents(const std::vector<Rule>& rules) {
  const Index each = rules.front().coefficients.size() + 1;
  Vector theta(static_cast<Index>(rules.size()) * each);
  for (std::size_t i = 0; i < rules.size(); ++i)
    theta.segment(static_cast<Index>(i) * each, each) << rules[i].coefficients, rules[i].offset;
  return theta;
}

KnowledgeRows inParameters(KnowledgeRows rows, Index n,
                           const std::function<Vector(const Vector&)>& consequents) {
  Vector unit = Vector::Zero(n);
  const Vector zero = consequents(unit);
  Matrix map(zero.size(), n);
  for (Index j = 0; j < n; ++j) {
    unit[j] = 1.0;
    map.col(j) = consequents(unit) - zero;
    unit[j] = 0.0;
  }
  const Vector shift = rows.A * zero;
  rows.lower -= shift;
  rows.upper -= shift;
  rows.A = rows.A * map;
  return rows;
}

bool nearestInside(const KnowledgeRows& rows, const Matrix& H, Vector& theta) {
  const Index n = theta.size(), m = rows.A.rows();
  if (m == 0) return true;
  const Vector value = rows.A * theta;
  if ((value.array() >= rows.lower.array()).all() && (value.array() <= rows.upper.array()).all())
    return true;
  // in units in which H has ones on its diagonal
  const Vector unit = H.diagonal().cwiseMax(1e-12 * H.trace() + 1e-300).cwiseSqrt().cwiseInverse();
  QpProblem problem(n, m);
  problem.H = unit.asDiagonal() * H * unit.asDiagonal();
  problem.H.diagonal().array() += 1e-8;
  problem.A = rows.A * unit.asDiagonal();
  problem.a_lower = rows.lower - value;
  problem.a_upper = rows.upper - value;
  for (Index i = 0; i < m; ++i) {  // a row of its own unit each
    const double size = std::max(problem.A.row(i).norm(), 1e-300);
    problem.A.row(i) /= size;
    problem.a_lower[i] /= size;
    problem.a_upper[i] /= size;
  }
  QpSolver solver(n, m);
  const QpResult& found = solver.solve(problem);
  if (!found.usable()) return false;
  theta += unit.cwiseProduct(found.x);
  return true;
}

void imposeKnowledge(const DataSet& data, int output, const PriorKnowledge& known,
                     OutputModel& model) {
  if (known.empty()) return;
  const std::string& name = data.outputs[static_cast<std::size_t>(output)].name;
  const Regression rows = makeRegression(data, model.regressors, model.antecedents, output);
  const Matrix H = evidenceMetric(rows, model);
  bool inside = false;
  for (int i = 0; i < kShrinks && !inside; ++i) {
    if (known.max_pole > 0.0) shrinkPoles(output, known, model);
    Vector theta = stackedConsequents(model.rules);
    if (!nearestInside(knowledgeRows(model, output, data, known), H, theta)) break;
    unstack(theta, model);
    inside = keepsPoles(model, output, known);
  }
  require(inside, "known of " + name,
          "statements that a model of this structure can meet at once; none does");
}

std::vector<std::string> brokenKnowledge(const OutputModel& model, int output, const DataSet& data,
                                         const PriorKnowledge& known) {
  std::vector<std::string> broken;
  if (known.empty()) return broken;
  const Vector theta = stackedConsequents(model.rules);
  const auto check = [&](const PriorKnowledge& part, const char* words) {
    if (!part.empty() && !isInside(knowledgeRows(model, output, data, part), theta))
      broken.emplace_back(words);
  };
  PriorKnowledge part;
  part.gain = known.gain;
  check(part, "gain");
  part = {};
  part.monotone = known.monotone;
  check(part, "monotone");
  part = {};
  part.steady = known.steady;
  check(part, "steady");
  if (!keepsPoles(model, output, known)) broken.emplace_back("max_pole");
  return broken;
}

}  // namespace fpc
