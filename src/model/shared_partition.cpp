#include "model/shared_partition.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kSameSet = 1e-9;

bool near(double a, double b) {
  return a == b || std::abs(a - b) <= kSameSet * std::max(std::abs(a), std::abs(b));
}

bool sameSet(const Membership& a, const Membership& b) {
  return a.shape == b.shape && a.parameters.size() == b.parameters.size() &&
         std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), near);
}

bool sameRegion(const Rule& a, const Rule& b) {
  if (a.multivariate.has_value() != b.multivariate.has_value()) return false;
  if (a.multivariate)
    return a.multivariate->center.isApprox(b.multivariate->center, kSameSet) &&
           a.multivariate->inverse_covariance.isApprox(b.multivariate->inverse_covariance,
                                                       kSameSet);
  return std::equal(a.antecedents.begin(), a.antecedents.end(), b.antecedents.begin(),
                    b.antecedents.end(), sameSet);
}

bool samePartition(const OutputModel& a, const OutputModel& b) {
  return a.antecedents == b.antecedents &&
         std::equal(a.rules.begin(), a.rules.end(), b.rules.begin(), b.rules.end(), sameRegion);
}

}  // namespace

RuleSplit splitRules(const TsModel& model) {
  RuleSplit split;
  const auto& all = model.submodels;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].rules.size() > all[split.partition].rules.size()) split.partition = i;
  const OutputModel& shared = all[split.partition];
  for (std::size_t i = 0; i < all.size(); ++i)
    require(all[i].rules.size() == 1 || samePartition(all[i], shared),
            "model '" + model.name + "' submodels." + model.outputs[i].name,
            "the antecedents and sets of output " + model.outputs[split.partition].name +
                ", or a single rule: the rules' inputs are blended with one weight per rule, so "
                "all outputs must share one premise partition");
  for (std::size_t r = 0; r < shared.rules.size(); ++r) {
    split.rules.push_back(model);
    for (std::size_t i = 0; i < all.size(); ++i)
      split.rules.back().submodels[i].rules = {all[i].rules[all[i].rules.size() == 1 ? 0 : r]};
  }
  return split;
}

}  // namespace fpc
