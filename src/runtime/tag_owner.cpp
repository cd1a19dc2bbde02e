#include "runtime/tag_owner.hpp"

namespace fpc {

bool TagOwner::admits(const std::string& publisher, double now_s, bool claims) {
  const bool free = ours_.empty() && (owner_.empty() || now_s - owner_s_ > timeout_s_);
  if (free && publisher != owner_ && !claims) return true;
  if (free || publisher == owner_) {
    if (publisher == second_) second_.clear();
    owner_ = publisher;
    owner_s_ = now_s;
    return true;
  }
  second_ = publisher;
  second_s_ = now_s;
  return false;
}

std::string TagOwner::problem(double now_s) const {
  if (second_.empty() || now_s - second_s_ > kShown) return "";
  if (!ours_.empty()) return tag_ + " is published by " + second_ + " as well: the plant hears it";
  return tag_ + " has two publishers: " + owner_ + " counts, " + second_ + " is refused";
}

}  // namespace fpc
