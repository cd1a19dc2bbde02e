#include "papers/verdict.hpp"

#include <cmath>

namespace fpc::papers {
namespace {

Verdict ofStatement(const Claim& c) {
  const double over = c.here - c.paper;
  const bool holds = c.direction == Direction::kLower    ? over <= 0.0
                     : c.direction == Direction::kHigher ? over >= 0.0
                                                         : std::abs(over) <= c.tolerance.absolute;
  return holds ? Verdict::kHolds : Verdict::kFails;
}

Verdict ofFigure(const Claim& c) {
  const double off = std::abs(c.here - c.paper), size = std::abs(c.paper);
  if (off <= c.tolerance.absolute || off <= c.tolerance.reproduced * size)
    return Verdict::kReproduced;
  const bool better = (c.direction == Direction::kLower && c.here < c.paper) ||
                      (c.direction == Direction::kHigher && c.here > c.paper);
  if (better) return Verdict::kBetter;
  return off <= c.tolerance.close * size ? Verdict::kClose : Verdict::kNotReproduced;
}

}  // namespace

Verdict verdictOf(const Claim& claim) {
  if (!claim.comparable) return Verdict::kNotComparable;
  if (!std::isfinite(claim.here) || !std::isfinite(claim.paper)) return Verdict::kNoResult;
  if (!claim.statement) return ofFigure(claim);
  const Verdict verdict = ofStatement(claim);
  return claim.observed && verdict == Verdict::kHolds ? Verdict::kObserved : verdict;
}

const char* name(Verdict verdict) {
  static const char* const names[] = {"reproduced",     "close",          "better",
                                      "not_reproduced", "not_comparable", "holds",
                                      "fails",          "observed",       "no_result"};
  return names[static_cast<int>(verdict)];
}

bool isShort(Verdict verdict) {
  return verdict == Verdict::kNotReproduced || verdict == Verdict::kFails;
}

}  // namespace fpc::papers
