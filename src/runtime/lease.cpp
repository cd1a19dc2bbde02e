#include "runtime/lease.hpp"

namespace fpc {

void Lease::held(std::uint16_t word, double now_s) {
  if (was_ours_ && word != word_) {
    ++losses_;
    lost_s_ = now_s;
  }
  held_ = word;
  read_ = true;
  was_ours_ = word == word_;
}

std::optional<std::uint16_t> Lease::toWrite(bool claims) {
  if (!read_ || another() || (!claims && held_ == 0)) return {};
  if (!claims) was_ours_ = false;  // that it is gone next time is our own doing
  return claims ? word_ : std::uint16_t{0};
}

std::string Lease::problem(double now_s) const {
  if (another())
    return place_ + " holds " + std::to_string(held_) + ", the word of another master, not " +
           std::to_string(word_);
  if (now_s - lost_s_ <= kShown) return "somebody has taken our word out of " + place_;
  return "";
}

}  // namespace fpc
