// Whether a prediction interval holds fewer values of a record than chance explains.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Number of errors of which as many independent ones would tell as much of their mean:
/// n / (1 + 2 sum r(l)), where r(l) is their correlation at lag l about their own mean, summed from
/// l = 1 until it is no longer positive (Geyer's initial sequence), to lag 1000 at most. Values
/// that are not finite are gaps. Between 1 and n; 0 without any.
double independentCount(VectorRef errors);

/// The lowest share [%] of n independent values inside an interval that is to hold `stated` [%] of
/// them (0 < stated < 100) that chance leaves: fewer come in less than one of 1000 records
/// (binomial distribution). 0 if n < 1.
double leastCoverage(double n, double stated);

}  // namespace fpc
