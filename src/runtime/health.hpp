// How a member of the exchange is, in one word and in a sentence, and what the plant makes of all.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fmbpc/base/event.hpp"

namespace fpc {

/// Values are those of LoopState.msg; the larger, the worse, but for finished.
enum class LoopMode : std::uint8_t {
  kStarting = 1,
  kAutomatic = 2,
  kManual = 3,
  kHeld = 4,      ///< the last input stays: paused, or data missing
  kDegraded = 5,  ///< it works, with less than it should
  kFallback = 6,  ///< the configured input, because nobody answers
  kStalled = 7,   ///< nothing moves
  kFinished = 8,
  kFailed = 9,
};
const char* wordOf(LoopMode mode);

struct Health {
  LoopMode mode{LoopMode::kStarting};
  EventCode code{EventCode::kNone};  ///< of the reason; kNone: all is well
  std::string words;                 ///< the reason
  std::vector<std::string> missing;  ///< nodes that are waited for
};

/// OK, WARN and ERROR of diagnostics: 0, 1, 2.
int levelOf(LoopMode mode);
/// "stalled: no action for sample 17 (missing: /clp_optimizer)"
std::string sentence(const Health& health);

/// Shows a change for the worse at once, one for the better only after it has lasted.
class Hysteresis {
 public:
  explicit Hysteresis(double hold_s) : hold_s_(hold_s) {}
  const Health& show(const Health& now, double now_s);

 private:
  double hold_s_, better_since_s_{-1};
  bool empty_{true};
  Health shown_;
};

/// Hears the beat of every member; who has been silent for longer than kSilence is missing. A
/// member that is still (or again) starting while the run goes on does not do its part: as bad as
/// degraded.
class RingWatch {
 public:
  static constexpr double kBeat = 0.5;     ///< [s] between two beats
  static constexpr double kSilence = 1.1;  ///< [s]
  static constexpr double kGrace = 2.5;    ///< [s], with the hysteresis of a member and its beats

  explicit RingWatch(std::vector<std::string> nodes) : nodes_(std::move(nodes)) {}
  /// A run begins: members that are starting have kGrace to say that they have begun.
  void begin(double now_s) { begun_s_ = now_s; }
  void hear(const std::string& node, const Health& health, double now_s);
  std::vector<std::string> silent(double now_s) const;  ///< of those expected, in their order
  /// What the members say that are not as they should be: the worst of it, with its node.
  Health worst(double now_s) const;

 private:
  struct Beat {
    Health health;
    double at_s;
  };
  std::vector<std::string> nodes_;
  std::map<std::string, Beat> beats_;
  double begun_s_{-kGrace};
};

}  // namespace fpc
