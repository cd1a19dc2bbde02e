// The part of `fmbpc stability` that asks the whole loop, whatever its law: margins at points of
// its run, and with the fuzzy model's rules one by one in the place of the plant.
#pragma once

#include <functional>
#include <string>

#include "base/ordered_json.hpp"
#include "config/loop_file.hpp"

namespace fpc::tool {

/// "points" of stability.json: where the loop is led, its margins, a verdict in words.
/// @throws InputError for an endless run. `show` is told what is looked at.
OrderedJson marginsOf(const LoopFile& loop, int points,
                      const std::function<void(const std::string&)>& show);
/// One line a point.
std::string marginsText(const OrderedJson& points, const OrderedJson& units);

}  // namespace fpc::tool
