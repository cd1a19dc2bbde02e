// taieb2017: the linear example (eqs. 4-6), the tank as printed (eqs. 22, 24) and the steady inputs
// of the reactor (eq. 28).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/steady_state.hpp"
#include "config/structure_file.hpp"
#include "control/fuzzy_lq/quadratic_law.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/plant/plant.hpp"
#include "identification/identify.hpp"
#include "papers/expression.hpp"
#include "papers/run_data.hpp"
#include "papers/runs.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

/// Eq. 4 with states x11, x12, x21, x22.
AffineModel example() {
  AffineModel m;
  m.A = Eigen::Vector4d(0.9401, 0.9524, 0.9083, 0.9306).asDiagonal();
  m.B = (Matrix(4, 2) << 1, 0, 0, 1, 1, 0, 0, 1).finished();
  m.C = (Matrix(2, 4) << -0.7664, 0.9, 0, 0, 0, 0, -0.6055, 1.3472).finished();
  m.g = Vector::Zero(4);
  return m;
}

/// radius(Gy1, Gy2, Gu1, Gu2, each|together): spectral radius of the closed loop with the state
/// (x, u(k-1)), inputs solved each by itself (eq. 6) or together.
Values radius(const Words& w) {
  const auto pair = [&](std::size_t i) {
    return Vector(Eigen::Vector2d(toNumber(w[i]), toNumber(w[i + 1])));
  };
  const QuadraticWeights weights{pair(0), Vector::Zero(2), pair(2)};
  const AffineModel m = example();
  const bool together = placeOf(w[4], {"each", "together"}) == 1;
  const QuadraticLaw law = makeQuadraticLaw(m, {1, 1, together}, weights);
  Matrix loop(6, 6);
  loop << m.A - m.B * law.K, m.B * law.previous, -law.K, law.previous;
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

/// Eq. 22 as printed, one sample on: the area is missing beside H(k-1).
double printedLevel(double H, double Q) {
  const double A = 0.04, a = 1e-4, Hs = 0.015, g = 9.81, Te = 0.1;
  return (H + Te * (Q - 0.6 * a * std::sqrt(2.0 * g * (H - Hs)))) / A;
}

/// printed_level(): the farthest of eq. 22 from the plant, over each sample of a run that starts at
/// a level and a flow of it.
Values farthestLevel(const Words&) {
  const RunRecord& run = recordOf("surge_tank_excite");
  double farthest = 0.0;
  for (std::size_t k = 1; k < run.samples.size(); ++k) {
    const Vector &from = run.samples[k - 1].state.state, &to = run.samples[k].state.state;
    farthest = std::max(farthest, std::abs(printedLevel(from[0], from[1]) - to[0]));
  }
  return farthest;
}

/// Of our record, rules by their level.
const std::vector<Rule>& tankRules() {
  static const std::vector<Rule> rules = [] {
    const Structure structure = readStructure(findStructure("surge_tank"));
    return identify(dataOf(recordOf("surge_tank_excite"), structure), structure)
        .model.submodels.at(0)
        .rules;
  }();
  require(rules.size() == 2, "surge_tank", "two rules, as printed");
  return rules;
}

/// tank_coefficient(RULE, TERM): as identified here.
Values tankCoefficient(const Words& w) {
  return tankRules().at(toIndex(w[0])).coefficients[static_cast<Eigen::Index>(toIndex(w[1]))];
}

/// largest_pole(a1, a2, a3): of y(k) = a1 y(k-1) + a2 y(k-2) + a3 y(k-3).
double largestPole(const Eigen::Vector3d& a) {
  Matrix companion = Matrix::Zero(3, 3);
  companion.row(0) = a.transpose();
  companion(1, 0) = companion(2, 1) = 1.0;
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

/// steady_input(Ca, T, q|qc): under which the reactor rests there: the equations solved for the
/// inputs, in logarithms because both are positive. NaN: there are none.
Values steadyInput(const Words& w) {
  const auto plant = makePlant("mimo_cstr");
  const Vector state = Eigen::Vector2d(toNumber(w[0]), toNumber(w[1])),
               feed = Eigen::Vector3d(1.0, 350.0, 350.0);
  const Derivative rates = [&](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> f) {
    plant->derivatives(state, x.array().exp().matrix(), feed, f);
  };
  const SteadyState found =
      findSteadyState(rates, Vector::Constant(2, std::log(100.0)), Vector(0), Vector(0));
  const auto i = static_cast<Eigen::Index>(placeOf(w[2], {"q", "qc"}));
  return found.ok() ? std::exp(found.x[i]) : kNotPrinted;
}

const bool kRegistered =
    registerComputation("radius", 5, radius) &&
    registerComputation("printed_level", 0, farthestLevel) &&
    registerComputation("tank_coefficient", 2, tankCoefficient) &&
    registerComputation("tank_pole", 1,
                        [](const Words& w) {
                          return largestPole(tankRules().at(toIndex(w[0])).coefficients.head(3));
                        }) &&
    registerComputation("largest_pole", 3,
                        [](const Words& w) {
                          return largestPole({toNumber(w[0]), toNumber(w[1]), toNumber(w[2])});
                        }) &&
    registerComputation("steady_input", 3, steadyInput);

}  // namespace
}  // namespace fpc::papers
