// How much may wait for a listener. Both ends of a topic keep what the other has not taken yet: a
// publisher for each of its listeners alike, a subscriber for its own handler alone.
#pragma once

#include <cstdint>

#include "config/loop_file.hpp"

namespace fpc {

enum class ListenerKind {
  kLaw,     ///< answers samples: measurement, base_action, predictive_action
  kRecord,  ///< must have every sample: recorder, identifier, bags; what is published for a record
  kPeer,    ///< what members of the exchange tell each other besides samples; the plant
  kViewer,  ///< commands of people, signals, the clock
};

/// Messages; the oldest go first. Bounded for all, so that a listener that hangs costs no more. In
/// lockstep and paced nothing is lost, since the plant waits. In realtime it does not, and a law
/// answers the newest only (see Newest): its queue has room for what is refused before that.
constexpr std::uint32_t queueOf(ListenerKind kind, Pace pace) {
  constexpr std::uint32_t kEverySample = 10000, kFew = 100, kPeople = 1000;
  switch (kind) {
    case ListenerKind::kLaw:
      return pace == Pace::kRealtime ? kFew : kEverySample;
    case ListenerKind::kRecord:
      return kEverySample;
    case ListenerKind::kPeer:
      return kFew;
    case ListenerKind::kViewer:
      return kPeople;
  }
  return kEverySample;
}

/// Where the pace does not matter.
constexpr std::uint32_t queueOf(ListenerKind kind) { return queueOf(kind, Pace::kLockstep); }

/// Whether a law that lags skips all samples but the newest.
constexpr bool answersNewestOnly(Pace pace) { return pace == Pace::kRealtime; }

}  // namespace fpc
