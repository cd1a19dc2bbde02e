// One output's record made ready for a search: scaled, cut into blocks, its sensor's limits found.
#pragma once

#include <string>
#include <vector>

#include "identification/data_set.hpp"
#include "identification/prior_knowledge.hpp"
#include "identification/recurrent_fit.hpp"

namespace fpc {

/// Shift and scale of every column of a data set, and what the search reads off an output.
struct AutoData {
  const DataSet* data{};
  int output{};
  PriorKnowledge known;          ///< of this output
  Matrix scaled;                 ///< rows x columns, (value - shift) / scale
  Vector shift, scale;           ///< of each column
  double lower{}, upper{};       ///< limits of the sensor in scaled units; equal: none seen
  bool may_be_absolute{false};   ///< values reach down to zero and never below
  double rate{1.0};              ///< rms change per sample over the deviation
  double noise{};                ///< std of the measurement noise, scaled
  std::vector<Stretch> windows;  ///< the blocks of the cross-validation, in order
  std::vector<Stretch> all;      ///< what the last fit may use

  double y(Eigen::Index k) const { return scaled(k, output); }
};

/// @param blocks  of the cross-validation
/// @param most    rows that the search uses; beyond it the blocks are windows of the record
AutoData prepareAuto(const DataSet& data, int output, int blocks, Eigen::Index most,
                     Eigen::Index most_last);

/// y and the values of `exogenous` (inputs and disturbances with their lags), scaled; with
/// `absolute` y keeps its zero. Lags before the record's start take the first value.
RecurrentData recurrentData(const AutoData& prepared, const std::vector<Regressor>& exogenous,
                            bool absolute);

Eigen::Index rowsOf(const std::vector<Stretch>& stretches);

/// Stretches without the block `left_out` (-1: none), neighbours joined.
std::vector<Stretch> trainingStretches(const AutoData& prepared, int left_out);

}  // namespace fpc
