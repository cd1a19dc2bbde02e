// The structures that a search tries, stage by stage.
#pragma once

#include "identification/auto_search.hpp"

namespace fpc {

using Candidates = std::vector<Candidate>;

/// A few simple linear models, enough to tell delays apart.
Candidates delayCandidates(const Candidate& base);
Candidates linearCandidates(const Candidate& base, bool states);
/// Linear models of longer pasts, up to ten values.
Candidates longerLines(const Candidate& base);
/// Linear models that take later values of the inputs as well, from `second` on.
Candidates laterLines(const Candidate& base, const std::vector<int>& second);
/// Two and three rules on the orders of the best linear models.
Candidates ruleCandidates(const Candidate& base, const std::vector<Judgement>& linear);
/// The best with other ridges, numbers of rules and starts.
Candidates refinedRules(const std::vector<Judgement>& regressors);
Candidates stateCandidates(const Candidate& base, bool absolute);
/// The best with inputs that act earlier or later than a linear model of the past told.
Candidates shiftedLines(const std::vector<Judgement>& linear);
Candidates shiftedStates(const std::vector<Group>& state);
/// The best with other ridges and numbers of rules.
Candidates refinedStates(const std::vector<Group>& state);

}  // namespace fpc
