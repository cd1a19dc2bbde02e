// What can be read out of a bag. In a build with ROS done in room ros, else refused in words
// (tool/no_bags.cpp).
#pragma once

#include <string>

#include "base/csv.hpp"
#include "config/loop_file.hpp"
#include "runtime/replay.hpp"

namespace fpc {

/// The table that the same run writes to trajectory.csv.
/// Columns time[h], outputs, inputs, measured disturbances, from plant_info and measurement alone.
/// Row k holds y(k), d(k) and the input applied in [t_k, t_k + Ts): measurement k + 1 tells it, so
/// the last row has none. Repeated steps count once; rows of steps that were not recorded are
/// empty. @throws InputError naming the bag: unreadable or not closed, recorded with other
/// messages, more than one plant or run, a run without plant_info, sizes that disagree.
CsvTable readBag(const std::string& file);

/// The loop as the nodes read it (topic `loop_text`, which only a bag has).
/// @throws InputError if the bag cannot be read, or holds none or several.
std::string loopTextOf(const std::string& bag);

/// What the bag holds of one run of the loop, for replay(): of its `run`-th, from 1; 0: of the only
/// one. @throws InputError if it cannot be read, holds several plants, several runs and `run` is 0,
/// or fewer than `run`.
RecordedRun readBagRun(const std::string& bag, const LoopFile& loop, int run = 0);

}  // namespace fpc
