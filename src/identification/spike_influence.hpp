// Spikes of inputs: real ones move the outputs, misprints do not.
#pragma once

#include "identification/data_set.hpp"

namespace fpc {

/// Of the `rows` where an input or disturbance (`column`) spikes, those after which a linear model
/// of the record predicts the outputs better (half the squared error or less) if the spike had not
/// been. `outliers` are rows of each output that say nothing.
std::vector<Eigen::Index> unnoticed(const DataSet& data, Eigen::Index column,
                                    const std::vector<Eigen::Index>& rows,
                                    const std::vector<std::vector<Eigen::Index>>& outliers);

/// Of the `rows` where an output spikes, those that the inputs explain: a linear model of values
/// and squares of inputs and disturbances, fitted to the other rows and run freely over the spike,
/// errs by less than half of what a straight line over it does.
std::vector<Eigen::Index> explained(const DataSet& data, Eigen::Index output,
                                    const std::vector<Eigen::Index>& rows);

/// Straight lines over `rows` between their known neighbours.
void bridge(Eigen::Ref<Vector> values, const std::vector<Eigen::Index>& rows);

/// The range of a column as its data now are; of a column at rest it stays.
void setRange(DataSet& data, std::size_t column);

}  // namespace fpc
