#include "analysis/fuzzy_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/steady_state.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {
namespace {

constexpr double kSame = 1e-6;  // relative
constexpr int kGrid = 9;

double centreOf(const Rule& rule, std::size_t antecedent) {
  return rule.multivariate ? rule.multivariate->center[static_cast<Eigen::Index>(antecedent)]
                           : centre(rule.antecedents[antecedent]);
}

/// Values of output i that its sets name, and points between and around them.
std::vector<double> candidates(const TsModel& model, int output) {
  std::vector<double> values;
  for (const auto& submodel : model.submodels)
    for (std::size_t a = 0; a < submodel.antecedents.size(); ++a) {
      const Regressor& r = submodel.antecedents[a];
      if (r.kind != SignalKind::kOutput || r.index != output) continue;
      for (const auto& rule : submodel.rules) values.push_back(centreOf(rule, a));
    }
  if (values.empty()) values.push_back(usualValue(model, SignalKind::kOutput, output));
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double lower = *least, span = std::max(*most - *least, 1e-3);
  for (int i = 0; i < kGrid; ++i) values.push_back(lower + span * (1.5 * i / (kGrid - 1) - 0.25));
  return values;
}

}  // namespace

double centre(const Membership& set) {
  const auto& p = set.parameters;
  switch (set.shape) {
    case MembershipShape::kGaussian:
      return p[0];
    case MembershipShape::kTriangular:
      return p[1];
    default:
      return 0.5 * (p[1] + p[2]);
  }
}

double usualValue(const TsModel& model, SignalKind kind, int index) {
  double sum = 0.0;
  int count = 0;
  for (const auto& submodel : model.submodels)
    for (std::size_t a = 0; a < submodel.antecedents.size(); ++a)
      if (submodel.antecedents[a].kind == kind && submodel.antecedents[a].index == index)
        for (const auto& rule : submodel.rules) {
          sum += centreOf(rule, a);
          ++count;
        }
  if (count > 0) return sum / count;
  const SignalInfo& info = model.signals(kind)[static_cast<std::size_t>(index)];
  const double middle = 0.5 * (info.lower + info.upper);
  return std::isfinite(middle) ? middle : 0.0;
}

std::vector<FuzzyEquilibrium> fuzzyEquilibria(const TsModel& model, VectorRef u, VectorRef d) {
  LocalModel local(model);
  Vector rest(local.stateSize());
  const Vector input = u, load = d;
  const Derivative f = [&](VectorRef y, VectorRef, VectorRef, Eigen::Ref<Vector> lack) {
    local.restState(y, input, load, rest);
    local.blend(rest, load);
    const AffineModel& m = local.affine();
    lack = m.C * (m.A * rest + m.B * input + m.g) - y;
  };
  const auto n_y = static_cast<Eigen::Index>(model.outputs.size());
  std::vector<std::vector<double>> values;
  std::size_t longest = 0;
  for (Eigen::Index i = 0; i < n_y; ++i) {
    values.push_back(candidates(model, static_cast<int>(i)));
    longest = std::max(longest, values.back().size());
  }
  std::vector<FuzzyEquilibrium> found;
  for (std::size_t k = 0; k < longest; ++k) {
    Vector start(n_y);
    for (Eigen::Index i = 0; i < n_y; ++i) {
      const auto& list = values[static_cast<std::size_t>(i)];
      start[i] = list[k % list.size()];
    }
    const SteadyState steady = findSteadyState(f, start, Vector(), Vector());
    if (!steady.ok()) continue;
    const bool twice = std::any_of(found.begin(), found.end(), [&](const FuzzyEquilibrium& other) {
      return (other.outputs - steady.x).norm() <= kSame * (1e-3 + steady.x.norm());
    });
    if (twice) continue;
    const LinearModel blended = blendedModel(model, steady.x, input, load);
    found.push_back({steady.x, eigenvalues(blended.affine.A)});
  }
  return found;
}

}  // namespace fpc
