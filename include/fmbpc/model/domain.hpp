// Where a model's identification data were, and how far its predictions may be trusted elsewhere.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

struct TsModel;

/// The data as a few balls that cover them, in the space of the model's signals at one sample: the
/// outputs, the inputs, the disturbances, in this order, each divided by its scale. Empty without
/// centres: nothing is known but the ranges of the signals.
struct ModelDomain {
  Matrix centres;   ///< n n_c, in the signals' units
  Vector scale;     ///< n, > 0; infinite: the signal does not count
  double radius{};  ///< of the balls, in scaled units
  bool empty() const { return centres.cols() == 0; }
  /// @throws InputError naming domain.KEY; n: the model's signals.
  void validate(Eigen::Index n) const;
};

/// At most `centres` of the data's own rows, each the farthest from those before it (gonzalez1985),
/// and the radius that covers all rows; scales are the ranges. Rows with missing values are
/// left out. Works on at most 5000 rows, evenly spaced.
ModelDomain makeDomain(const Matrix& values, int centres = 60);

/// How far a model is trusted at one point, 0..1: 1 inside a ball, as 99 % of its data are, then
/// (1 + cos(pi t)) / 2 with t from 0 at its surface to 1 at kDomainFade radii, or kRangeFade of the
/// ranges, further, whatever is more. Inputs count by how far they are beyond all their data, not
/// by how near to a datum: a law that may only repeat the inputs of a record cannot act. Without a
/// domain the same of the distance from the box of the ranges, in parts of each range, over
/// kRangeFade. No allocation. Points: n, outputs, inputs, disturbances of the model.
double trustOf(const TsModel& model, VectorRef point);
constexpr double kDomainFade = 1.0;
constexpr double kRangeFade = 0.25;
/// Whether the model says anything about its domain.
bool knowsDomain(const TsModel& model);

}  // namespace fpc
