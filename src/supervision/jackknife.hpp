// A statistic of blocks with its bounds.
#pragma once

#include <cmath>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// An estimate between its bounds; NaN: not known.
struct Bounded {
  double value{kNaN}, lower{kNaN}, upper{kNaN};
};

/// of(b) is the statistic of all blocks but b, of(-1) that of all of them. Bounds are t standard
/// errors away, by the delete-one jackknife. Source: efron1993, chapter 11
template <typename Of>
Bounded jackknife(int blocks, double t, const Of& of) {
  Bounded result;
  result.value = of(-1);
  double mean = 0.0;
  std::vector<double> without;
  for (int b = 0; b < blocks; ++b) {
    without.push_back(of(b));
    mean += without.back() / blocks;
  }
  double squares = 0.0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  const double width = t * std::sqrt(squares * (blocks - 1.0) / blocks);
  result.lower = result.value - width;
  result.upper = result.value + width;
  return result;
}

}  // namespace fpc
