// From a printed figure and ours to a verdict: the one place where verdicts are made.
#pragma once

#include <string>
#include <vector>

namespace fpc::papers {

enum class Verdict {
  kReproduced,     ///< within `reproduced` of the printed figure, or within `absolute`
  kClose,          ///< within `close`
  kBetter,         ///< beyond `reproduced` on the side that the figure is better on
  kNotReproduced,  ///< none of these
  kNotComparable,  ///< the row gives the reason
  kHolds,          ///< a statement tested here: true
  kFails,          ///< a statement tested here: false
  kObserved,       ///< a statement that no wrong plant or law changes: shown, not judged
  kNoResult        ///< a run failed, or gave no figure
};

/// Which side of the printed figure is the better one; of a statement, which side it claims.
enum class Direction { kEqual, kLower, kHigher };

/// Deviations that a row states, as shares of the printed figure; `absolute` in its unit.
struct Tolerance {
  double reproduced{0.01};
  double close{0.1};
  double absolute{0.0};  ///< half a unit of the last printed digit, or for figures printed as 0
};

/// What is judged. A figure: `paper` is what it prints. A statement: `paper` is the limit it sets.
struct Claim {
  bool statement{false};
  double paper{}, here{};
  Tolerance tolerance{};
  Direction direction{Direction::kEqual};
  bool comparable{true};
  bool observed{false};  ///< a statement whose holding proves nothing
};

Verdict verdictOf(const Claim& claim);
const char* name(Verdict verdict);
/// Figures that fall short and statements that do not hold.
bool isShort(Verdict verdict);

}  // namespace fpc::papers
