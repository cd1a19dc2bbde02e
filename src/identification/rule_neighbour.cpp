#include "identification/rule_neighbour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fpc {
namespace {

/// Without flanks: in or out, as operating modes are.
bool isCrisp(const Membership& set) {
  const auto& p = set.parameters;
  return set.shape == MembershipShape::kTrapezoidal && p[0] == p[1] && p[2] == p[3];
}

/// Where a set holds fully.
double centre(const Membership& set) {
  const auto& p = set.parameters;
  if (set.shape == MembershipShape::kGaussian) return p[0];
  if (set.shape == MembershipShape::kTriangular) return p[1];
  return p[0] == p[1] ? p[2] : p[2] == p[3] ? p[1] : 0.5 * (p[1] + p[2]);  // a shoulder ends there
}

double centreOf(const Rule& rule, std::size_t variable) {
  return rule.multivariate ? rule.multivariate->center[static_cast<Eigen::Index>(variable)]
                           : centre(rule.antecedents[variable]);
}

/// How far the centres of all rules' sets on each variable lie apart.
std::vector<double> spansOf(const OutputModel& model) {
  std::vector<double> spans;
  for (std::size_t v = 0; v < model.antecedents.size(); ++v) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Rule& rule : model.rules) {
      low = std::min(low, centreOf(rule, v));
      high = std::max(high, centreOf(rule, v));
    }
    spans.push_back(high > low ? high - low : 1.0);
  }
  return spans;
}

double distance(const Rule& a, const Rule& b, const std::vector<double>& spans) {
  double sum = 0.0;
  for (std::size_t i = 0; a.multivariate && i < spans.size(); ++i)
    sum += std::abs(centreOf(a, i) - centreOf(b, i)) / spans[i];
  for (std::size_t i = 0; i < a.antecedents.size(); ++i) {
    const Membership &one = a.antecedents[i], &other = b.antecedents[i];
    if (one == other) continue;
    if (isCrisp(one) || isCrisp(other)) return std::numeric_limits<double>::infinity();
    sum += std::abs(centre(one) - centre(other)) / spans[i];
  }
  return sum;
}

}  // namespace

int nearestFitted(const OutputModel& model, const std::vector<RuleFit>& fits, std::size_t i) {
  const std::vector<double> spans = spansOf(model);
  int nearest = -1;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < fits.size(); ++j) {
    if (fits[j].status != RuleStatus::kFitted) continue;
    const double way = distance(model.rules[i], model.rules[j], spans);
    if (way >= shortest) continue;
    shortest = way;
    nearest = static_cast<int>(j);
  }
  return nearest;
}

}  // namespace fpc
