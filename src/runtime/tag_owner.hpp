// A tag of a plant behind topics is one node's: values of two would be mixed, and nobody would know
// what is controlled.
#pragma once

#include <string>

namespace fpc {

/// The first that publishes the tag owns it. Others are refused and named as long as the owner has
/// spoken within the time-out; after that the next one that speaks is the owner (a plant that was
/// started anew under another name). A tag of `ours` is ours for ever, and who else publishes it is
/// heard by the plant.
class TagOwner {
 public:
  TagOwner(std::string tag, double timeout_s, std::string ours = "")
      : tag_(std::move(tag)), ours_(std::move(ours)), owner_(ours_), timeout_s_(timeout_s) {}
  /// False: the value is to be dropped. `claims`: it makes its publisher the owner of a free tag (a
  /// value that is no number does not).
  bool admits(const std::string& publisher, double now_s, bool claims = true);
  /// Who else publishes the tag, in words, while that goes on; empty: nobody.
  std::string problem(double now_s) const;

 private:
  static constexpr double kShown = 2.0;  // [s] after the second publisher's last value

  std::string tag_, ours_, owner_, second_;
  double timeout_s_, owner_s_{}, second_s_{};
};

}  // namespace fpc
