// Which disturbance a channel of a pattern or record drives.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// For messages.
inline std::string channelName(const std::string& name) {
  return "disturbance: channel '" + name + "'";
}

/// Gives each channel the row of its disturbance, once.
class ChannelRows {
 public:
  explicit ChannelRows(const std::vector<std::string>& names)
      : names_(names), taken_(names.size(), false) {}
  /// @throws InputError naming the channel: unknown, or for the second time.
  Eigen::Index take(const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    require(found != names_.end(), channelName(name), "one of " + join(names_));
    const auto row = static_cast<std::size_t>(found - names_.begin());
    require(!taken_[row], channelName(name), "every channel only once");
    taken_[row] = true;
    return static_cast<Eigen::Index>(row);
  }

 private:
  const std::vector<std::string>& names_;
  std::vector<bool> taken_;
};

}  // namespace fpc
