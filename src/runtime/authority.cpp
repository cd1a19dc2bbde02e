#include "runtime/authority.hpp"

#include <algorithm>

namespace fpc {

const std::vector<std::string>& Authority::publishersOf(const std::string& topic) const {
  static const std::vector<std::string> kAnyone;
  const auto found = publishers_.find(topic);
  return found == publishers_.end() ? kAnyone : found->second;
}

bool Authority::guards(const std::string& topic) const { return !publishersOf(topic).empty(); }

bool Authority::admits(const std::string& topic, const std::string& publisher) {
  const auto& names = publishersOf(topic);
  if (names.empty() || std::find(names.begin(), names.end(), publisher) != names.end()) return true;
  refuse(topic, publisher);
  return false;
}

bool Authority::speaksFor(const std::string& topic, const std::string& publisher,
                          const std::string& node) {
  if (publisher == node || (!manager_.empty() && publisher == manager_)) return true;
  refuse(topic, publisher);
  return false;
}

void Authority::refuse(const std::string& topic, const std::string& publisher) {
  std::string what = topic + " from " + publisher;
  latest_ = what;
  if (refused_.size() >= kMostNamed && refused_.count(what) == 0) what = topic + " from others";
  ++refused_[what];
}

bool RateLimit::pass(double now_s) {
  if (started_) left_ = std::min(burst_, left_ + (now_s - last_s_) * per_s_);
  started_ = true;
  last_s_ = now_s;
  if (left_ < 1.0) {
    ++dropped_;
    return false;
  }
  left_ -= 1.0;
  return true;
}

}  // namespace fpc
