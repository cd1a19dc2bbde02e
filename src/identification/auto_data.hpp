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
  std::vector<bool> unused;      ///< inputs, then disturbances, that no model takes; may be empty
  double lower{}, upper{};       ///< limits of the sensor in scaled units; equal: none seen
  bool may_be_absolute{false};   ///< values reach down to zero and never below
  double rate{1.0};              ///< rms change per sample over the deviation
  double noise{};                ///< std of the measurement noise, scaled
  Eigen::Index reach{};          ///< samples after which runs start anew; 0: free to the end
  std::vector<Stretch> windows;  ///< the blocks of the cross-validation, in order
  std::vector<Stretch> all;      ///< what the last fit may use

  double y(Eigen::Index k) const { return scaled(k, output); }
  /// True if an input or disturbance (by its number) tells nothing or is not to be used.
  bool isLeftOut(std::size_t cause) const {
    const std::size_t column = data->outputs.size() + cause;
    return (cause < unused.size() && unused[cause]) ||
           (column < data->constant.size() && data->constant[column]);
  }
};

/// @param blocks  of the cross-validation
/// @param most    rows that the search uses; beyond it the blocks are windows of the record
AutoData prepareAuto(const DataSet& data, int output, int blocks, Eigen::Index most,
                     Eigen::Index most_last);

/// y and the values of `exogenous` (inputs and disturbances with their lags), scaled; with
/// `absolute` y keeps its zero. Lags before the record's start take the first value.
RecurrentData recurrentData(const AutoData& prepared, const std::vector<Regressor>& exogenous,
                            bool absolute);

/// Free runs of these stretches: with `reach` pieces of so many rows, each behind the few measured
/// rows that start it; else the stretches themselves.
std::vector<Stretch> runsOf(const AutoData& prepared, const std::vector<Stretch>& stretches);
inline constexpr Eigen::Index kRunStart = 8;  ///< measured rows before each piece of `reach`

/// Samples that runs may take where free ones say nothing: a one-step or free-run linear model has
/// a pole outside the unit circle, or a real one so near it (1 - 2 / rows) that the record cannot
/// tell it from an integrator. 0 for other processes. At most 30, fewer where an unstable pole
/// would make 20 of an error of 1 before.
Eigen::Index reachOf(const AutoData& prepared);

Eigen::Index rowsOf(const std::vector<Stretch>& stretches);

/// What a fit may see without the block `left_out` (-1: none): neighbours joined, then runsOf().
std::vector<Stretch> trainingStretches(const AutoData& prepared, int left_out);

}  // namespace fpc
