// Who may say what in the exchange: publishers by topic. Others are refused and counted by name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace fpc {

/// Full names of nodes by topic (as in the loop file, without namespace). A topic that is not
/// listed, or lists nobody, is open to anyone.
using Publishers = std::map<std::string, std::vector<std::string>>;

class Authority {
 public:
  static constexpr std::size_t kMostNamed = 20;  ///< strangers that are counted by name

  Authority() = default;
  /// `manager`: the name by which all nodelets speak; empty: there are none.
  explicit Authority(Publishers publishers, std::string manager = {})
      : publishers_(std::move(publishers)), manager_(std::move(manager)) {}

  /// False: the message is to be dropped; it has been counted.
  bool admits(const std::string& topic, const std::string& publisher);
  /// What a message says of `node` counts only if it comes from that node itself. False: the
  /// message is to be dropped; it has been counted.
  bool speaksFor(const std::string& topic, const std::string& publisher, const std::string& node);
  /// Whether the topic is only for the nodes named.
  bool guards(const std::string& topic) const;
  const std::vector<std::string>& publishersOf(const std::string& topic) const;
  /// "measurement from /stranger" -> messages refused.
  const std::map<std::string, std::uint64_t>& refused() const { return refused_; }
  /// The latest refusal in words, empty if there is none.
  const std::string& latest() const { return latest_; }

 private:
  void refuse(const std::string& topic, const std::string& publisher);

  Publishers publishers_;
  std::string manager_;
  std::map<std::string, std::uint64_t> refused_;
  std::string latest_;
};

/// No more than `burst` at once and `per_s` on the average: keeps a flood of commands from starving
/// the loop.
class RateLimit {
 public:
  RateLimit(double per_s, double burst) : per_s_(per_s), burst_(burst), left_(burst) {}
  bool pass(double now_s);
  std::uint64_t dropped() const { return dropped_; }

 private:
  double per_s_, burst_, left_, last_s_{};
  bool started_{false};
  std::uint64_t dropped_{};
};

}  // namespace fpc
