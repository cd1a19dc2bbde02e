// dynamic_reconfigure for whatever controller a loop has: what may change comes from the table of
// its type, not from a file of generated code.
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "fmbpc/control/settings.hpp"
#include "ros/counted_vectors.hpp"

namespace fpc {

/// Serves ~set_parameters and latches ~parameter_descriptions and ~parameter_updates, as
/// dynamic_reconfigure::Server does. It starts with what the controller has, whatever the parameter
/// server holds; a change acts from the next sample on, and one that the controller refuses is
/// said and taken back, as is one of a caller who may not: the answer shows what is in force.
class SettingsServer {
 public:
  using Current = std::function<Settings()>;
  using Change = std::function<void(const Settings&)>;      ///< @throws InputError: refused
  using Refused = std::function<void(const std::string&)>;  ///< is told why
  using Allowed = std::function<bool(const std::string& caller)>;
  /// Nothing is advertised for an empty table.
  SettingsServer(ros::NodeHandle private_node, std::vector<SettingInfo> table, Current current,
                 Change change, Refused refused, Allowed allowed);
  void publish();  ///< what is in force now

 private:
  using Event = ros::ServiceEvent<dynamic_reconfigure::Reconfigure::Request,
                                  dynamic_reconfigure::Reconfigure::Response>;
  bool onSet(Event& event);

  std::string name_;  // of the node
  std::vector<SettingInfo> table_;
  Current current_;
  Change change_;
  Refused refused_;
  Allowed allowed_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer set_;
};

/// The table and values as messages; free of a master, for tests.
dynamic_reconfigure::Config settingsMessage(const std::vector<SettingInfo>& table,
                                            const Settings& settings);
/// Settings out of a request, in the order of the table; keys that the table does not have are
/// left out. @throws InputError for a number outside its range.
Settings settingsOf(const std::vector<SettingInfo>& table,
                    const dynamic_reconfigure::Config& config);

}  // namespace fpc
