// A bag of a run, recorded by loop.launch record:=true or rosbag, as the table that the same run
// writes to trajectory.csv.
#pragma once

#include <string>

#include "fmbpc/base/csv.hpp"

namespace fpc {

/// Columns time[h], outputs, inputs, measured disturbances, from plant_info and measurement alone.
/// Row k holds y(k), d(k) and the input applied in [t_k, t_k + Ts): measurement k + 1 tells it, so
/// the last row has none. Repeated steps count once; rows of steps that were not recorded are
/// empty. @throws InputError naming the bag: unreadable or not closed, recorded with other
/// messages, more than one plant or run, a run without plant_info, sizes that disagree.
CsvTable readBag(const std::string& file);

}  // namespace fpc
