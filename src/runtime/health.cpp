#include "runtime/health.hpp"

#include "fmbpc/base/text.hpp"

namespace fpc {

const char* wordOf(LoopMode mode) {
  switch (mode) {
    case LoopMode::kStarting:
      return "starting";
    case LoopMode::kAutomatic:
      return "automatic";
    case LoopMode::kManual:
      return "manual";
    case LoopMode::kHeld:
      return "held";
    case LoopMode::kDegraded:
      return "degraded";
    case LoopMode::kFallback:
      return "fallback";
    case LoopMode::kStalled:
      return "stalled";
    case LoopMode::kFinished:
      return "finished";
    case LoopMode::kFailed:
      return "failed";
  }
  return "unknown";
}

int levelOf(LoopMode mode) {
  if (mode == LoopMode::kAutomatic || mode == LoopMode::kFinished) return 0;
  return mode == LoopMode::kFailed || mode == LoopMode::kFallback ? 2 : 1;
}

std::string sentence(const Health& health) {
  std::string text = wordOf(health.mode);
  if (!health.words.empty()) text += ": " + health.words;
  if (!health.missing.empty()) text += " (missing: " + join(health.missing) + ")";
  return text;
}

const Health& Hysteresis::show(const Health& now, double now_s) {
  const bool better = !empty_ && levelOf(now.mode) < levelOf(shown_.mode);
  const bool ended = now.mode == LoopMode::kFinished || now.mode == LoopMode::kManual;
  if (!better || ended) {
    better_since_s_ = -1;
    shown_ = now;
    empty_ = false;
    return shown_;
  }
  if (better_since_s_ < 0) better_since_s_ = now_s;
  if (now_s - better_since_s_ >= hold_s_) {
    better_since_s_ = -1;
    shown_ = now;
  }
  return shown_;
}

namespace {

LoopMode gravity(LoopMode mode) { return mode == LoopMode::kStarting ? LoopMode::kDegraded : mode; }

}  // namespace

void RingWatch::hear(const std::string& node, const Health& health, double now_s) {
  beats_[node] = {health, now_s};
}

std::vector<std::string> RingWatch::silent(double now_s) const {
  std::vector<std::string> names;
  for (const std::string& node : nodes_) {
    const auto beat = beats_.find(node);
    if (beat == beats_.end() || now_s - beat->second.at_s > kSilence) names.push_back(node);
  }
  return names;
}

Health RingWatch::worst(double now_s) const {
  Health worst{LoopMode::kAutomatic, EventCode::kNone, "", {}};
  for (const std::string& node : nodes_) {
    const auto beat = beats_.find(node);
    if (beat == beats_.end() || now_s - beat->second.at_s > kSilence) continue;
    const Health& health = beat->second.health;
    const bool starting = health.mode == LoopMode::kStarting;
    if (starting && now_s - begun_s_ <= kGrace) continue;
    if (gravity(health.mode) <= gravity(worst.mode) || health.mode == LoopMode::kFinished) continue;
    worst = {health.mode, health.code == EventCode::kNone ? EventCode::kNodeDegraded : health.code,
             node + ": " +
                 (starting ? sentence({health.mode, health.code, health.words, {}}) : health.words),
             health.missing};
  }
  return worst;
}

}  // namespace fpc
