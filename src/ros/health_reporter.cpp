#include "ros/health_reporter.hpp"

#include <fmbpc/LoopState.h>

#include <utility>

#include "ros/conversions.hpp"
#include "ros/guard.hpp"
#include "ros/master_watch.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kLook = 0.25;  // [s] of wall time

bool same(const Health& a, const Health& b) {
  return a.mode == b.mode && a.words == b.words && a.missing == b.missing;
}

/// A node that cannot be reached is not in order, whatever it does; nor is a loop with a member
/// that cannot be, which the plant says for all. Other members say it without being worse for it.
Health withNetwork(Health health, bool summary) {
  const NetworkProblem network = networkProblem();
  const std::string& problem = network.here.empty() ? network.there : network.here;
  if (problem.empty() || health.mode == LoopMode::kFinished) return health;
  const bool its_own = summary || !network.here.empty();
  if (its_own && (health.mode == LoopMode::kAutomatic || health.mode == LoopMode::kManual))
    health.mode = LoopMode::kDegraded;
  if (health.code == EventCode::kNone) health.code = EventCode::kNetworkProblem;
  if (health.words.find(problem) == std::string::npos) health.words += "; " + problem;
  return health;
}

}  // namespace

HealthReporter::HealthReporter(ros::NodeHandle node, const ros::NodeHandle& private_node,
                               const std::string& title, const std::string& hardware_id,
                               bool summary, Source source)
    : source_(std::move(source)),
      name_(private_node.getNamespace()),
      summary_(summary),
      publisher_(
          node.advertise<fmbpc::LoopState>(topics::kLoopState, queueOf(ListenerKind::kPeer), true)),
      diagnostics_(node, private_node, title, hardware_id,
                   [this](Diagnostics::Status& status) { fill(status); }),
      timer_(SteadyTimer(node, kLook, [this] {
               const auto say = [this](const char* what) {
                 if (log_.pass()) ROS_ERROR("%s: health: %s", name_.c_str(), what);
               };
               callGuarded([this] { look(); }, say, say);
             }).started()) {}

// A new one at once, or the latest of each second of wall time.
void HealthReporter::say(const std::vector<Event>& events) {
  if (events.empty()) return;
  const std::uint64_t run_id = source_.sample().run_id;
  if (std::exchange(run_id_, run_id) != run_id) events_.clear();
  bool fresh = false;
  for (const Event& event : events) fresh = events_.add(event) || fresh;
  if (fresh || events_log_.pass())
    ROS_WARN("%s: sample %u: %s: %s", name_.c_str(), events.front().last,
             kindOf(worstOf(events).code).name, textOf(events).c_str());
}

void HealthReporter::look() {
  const double now_s = steadyNow();
  const Health before = shown_;
  shown_ = hysteresis_.show(withNetwork(source_.health(now_s), summary_), now_s);
  const bool changed = before.mode != shown_.mode || before.missing != shown_.missing;
  if (same(before, shown_) && now_s - published_s_ < RingWatch::kBeat - 0.5 * kLook) return;
  published_s_ = now_s;
  publish();
  if (changed) diagnostics_.update();
}

void HealthReporter::sayLast(const std::string& words) {
  if (shown_.mode == LoopMode::kFinished || shown_.mode == LoopMode::kFailed) return;
  shown_ = {LoopMode::kStalled, EventCode::kShutDown, words, {}};
  publish();
}

void HealthReporter::publish() {
  const StepHeader sample = source_.sample();
  fmbpc::LoopState msg;
  msg.header.stamp = toStamp(sample.time_ns);
  msg.run_id = sample.run_id;
  msg.step = sample.step;
  msg.node = name_;
  msg.summary = summary_;
  msg.mode = static_cast<std::uint8_t>(shown_.mode);
  msg.word = wordOf(shown_.mode);
  msg.code = kindOf(shown_.code).name;
  msg.reason = shown_.words;
  msg.missing = shown_.missing;
  msg.events = toMsg(events_.all());
  publisher_.publish(msg);
}

void HealthReporter::fill(Diagnostics::Status& status) const {
  status.summary(static_cast<unsigned char>(levelOf(shown_.mode)), shown_.words);
  status.add("mode", wordOf(shown_.mode));
  status.add("code", kindOf(shown_.code).name);
  for (const Event& event : events_.all())
    status.add("event " + std::string(kindOf(event.code).name) +
                   (event.signal.empty() ? "" : " of " + event.signal),
               event.count);
  source_.values(status);
}

}  // namespace fpc
