// Faults of a record that spoil a model in silence: frozen sensors, a change of unit half-way,
// inputs that cannot be told apart.
#pragma once

#include <string>
#include <vector>

#include "identification/data_set.hpp"

namespace fpc {

/// Rows first..last - 1.
struct FaultyRows {
  Eigen::Index first{}, last{};
};

/// Stretches in which a signal that else changes in nearly every row keeps one value, not its
/// lowest nor highest: at least 20 rows, and 5 times as long as all usual repetitions. Of outputs
/// only those in which inputs moved three times and more; none of inputs, which may rest.
/// On 159 columns of 12 public records it accuses none and finds 7 of 10 stretches of 20 rows and
/// more; the rule for running signals (FlatLine), which needs noise, 3 of 10 (record_faults_test).
std::vector<FaultyRows> frozenRows(const DataSet& data, Eigen::Index column);

/// From one row on the values and the moves of a column are larger (smaller) by the same factor,
/// within 40 % of 10, 60, 100, 1000, 3600, 10^4 or 10^6.
struct UnitChange {
  Eigen::Index row{};  ///< the first that differs; 0: none
  double factor{1.0};
};
UnitChange unitChange(const Eigen::Ref<const Vector>& values);

/// An input or disturbance that the others explain to 98 % and more, by linear regression on their
/// values of the same row and its neighbours.
struct Collinear {
  Eigen::Index column{};
  Eigen::Index partner{};  ///< the one among the others that is most like it
  double share{};          ///< explained, 0..1
};
std::vector<Collinear> collinearCauses(const DataSet& data);

/// All of these in words.
std::vector<std::string> faultRemarks(const DataSet& data);

}  // namespace fpc
