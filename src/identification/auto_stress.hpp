// What a fuzzy model does where no data were: it must not run away there.
#pragma once

#include "identification/auto_candidate.hpp"

namespace fpc {

/// Free runs under inputs that go beyond those of the stretches (the same moves made larger, and
/// each input held below and above its range) stay near the range of y, or no further from it than
/// a few times what `linear` does under the same inputs. A rule at the edge of the data is fitted
/// to little; one that is unstable there spoils another record and says nothing on this one.
/// Models of the output's past are also started at the lowest and at the highest y: the inputs as
/// they were must bring them back to the data's range (or less than a range beyond), if they bring
/// the linear one back. A second rest outside of the data catches runs that come near it.
bool endures(const Fitted& fitted, const Fitted& linear, const RecurrentData& record,
             const std::vector<Stretch>& stretches);

}  // namespace fpc
