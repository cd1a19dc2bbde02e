// What a person asks of a loop that runs over topics, answered in the same terminal. In a build
// with ROS done in room ros, else refused in words (tool/no_bags.cpp).
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace fpc {

enum class OperatorVerb { kSet, kDisturb, kManual, kAuto, kRelease, kShadow, kHandOver, kBack };

struct OperatorCommand {
  OperatorVerb verb{OperatorVerb::kSet};
  std::vector<std::pair<std::string, double>> values;  ///< set, disturb, manual: by name
  std::vector<std::string> names;                      ///< release; none: everything
  bool offset{false};                                  ///< set, disturb: added, not instead
  std::string loop;  ///< shadow: of the candidate; empty: how it is
};

/// Asks it of the loop on the present master (ROS_MASTER_URI, ROS_NAMESPACE) and waits for the
/// sample since which it is in force: what became of it, one line per thing asked.
/// @throws InputError if there is no loop, it refuses (with its reason), or nothing comes of it.
std::string askLoop(const OperatorCommand& command);

/// What is asked of a loop's action `commission`; paths as the controller's machine knows them.
struct CommissionWish {
  std::string brief, folder, until, again;
  int evaluations{}, members{};
};
/// Commissions the loop on the present master: the figures of all stages, in JSON. `show` gets what
/// is done, stage and text. @throws InputError as askLoop(); the stages that are done stay done.
std::string commissionLoop(const CommissionWish& wish,
                           const std::function<void(const std::string&, const std::string&)>& show);

}  // namespace fpc
