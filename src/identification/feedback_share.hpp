// Does an input answer to an output? Records of a closed loop give biased gains.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Share 0..1 of what is new in u(k), beyond its own past, that y(k-delay)..y(k-delay-3) explain; 0
/// where that may be chance. With delay 1 the y of the same row, on which an input that acts within
/// its sample shows as well, is left out. Both are regressed linearly; where u moves in most
/// samples, the rows that its past predicts worst (changes of the setpoint) are left out. In open
/// loop y holds nothing but u's past and noise: the F test that must be passed (F > 7 with 4
/// degrees of freedom) then fails but for fewer than one record in 200 (measured,
/// test/fuzzy/feedback_share_test.cpp). Source: granger1969, the direct test of causality.
double feedbackShare(VectorRef u, VectorRef y, int delay = 0);

}  // namespace fpc
