// The numbers of tables 4, 6, A1 and A2 (vallejo2021a), typed from the paper and from nothing else,
// so that model files can be held against them.
#pragma once

#include <vector>

namespace fpc::papers {

/// A row a rule: six of s, then five of x; the regressors that the rule has, then the offset.
const std::vector<std::vector<double>>& printedConsequents(int model);
/// A row a set, four numbers each: output by output, in it variable by variable, in it rule by
/// rule.
const std::vector<std::vector<double>>& printedSets(int model);
/// How many printed numbers a model file does not hold where it must; all of a row whose length
/// differs.
double unlike(const std::vector<std::vector<double>>& printed,
              const std::vector<std::vector<double>>& held);

}  // namespace fpc::papers
