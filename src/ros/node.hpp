// What all nodes have in common: how they start, refuse messages, and end.
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "config/loop_file.hpp"
#include "fmbpc/base/event.hpp"
#include "fmbpc/base/input_error.hpp"
#include "ros/counted_vectors.hpp"
#include "ros/guard.hpp"
#include "ros/master_watch.hpp"
#include "ros/newest.hpp"
#include "ros/queues.hpp"
#include "ros/quick_negotiation.hpp"
#include "ros/run_node.hpp"
#include "ros/steady_timer.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/authority.hpp"

namespace fpc {

/// Base of the node classes.
class Node {
 public:
  /// Who may say what: loop.publishers, names relative to the namespace of `node`. `name`: of the
  /// node, or of the nodelet, whose process has another.
  Node(const ros::NodeHandle& node, const LoopFile& loop, std::string name);
  virtual ~Node() = default;
  /// Called when the process is told to end, while it still can publish.
  virtual void sayLast() {}
  /// Called after spinning; the exit code of the process.
  virtual int finish() { return exit_code_; }

 protected:
  /// Ends the process with a non-zero exit code.
  void fail(const std::string& what);
  /// Ends the process with exit code 0.
  void done() { ros::shutdown(); }
  /// Runs a message handler; a message that it refuses (InputError) is dropped, counted by topic
  /// and logged. Whatever else goes wrong in it is logged as an error, and the node goes on.
  template <typename Handler>
  void guarded(const char* topic, Handler handler) {
    callGuarded(
        handler, [&](const char* why) { refuse(topic, why); },
        [&](const char* what) { mishap(topic, what); });
  }
  /// The same for a person's command, who is told: `tell(why)`.
  template <typename Handler, typename Tell>
  void guardedCommand(const char* topic, Handler handler, Tell tell) {
    guarded(topic, [&] {
      try {
        handler();
      } catch (const InputError& error) {
        tell(error.what());
        throw;
      }
    });
  }
  /// A timer on the steady clock, not started, whose handler is guarded. `what`: names it in
  /// counters and the log.
  template <typename Handler>
  SteadyTimer guardedTimer(const ros::NodeHandle& node, double period_s, const char* what,
                           Handler handler, SteadyTimer::Kind kind = SteadyTimer::Kind::kPeriodic) {
    return SteadyTimer(
        node, period_s, [this, what, handler] { guarded(what, handler); }, kind);
  }
  void refuse(const char* topic, const std::string& why);
  void mishap(const char* topic, const std::string& what);
  /// The message refused last, in words, for some seconds after it came; then empty.
  std::string refusedLately(double now_s) const;
  /// "running" with what refusedLately() says.
  std::string withRefusal(std::string words, double now_s) const;
  /// For the record, as of this sample: commands of people that were refused since it was asked
  /// last; the first ten that differ, in all.
  std::vector<Event> takeRefusedCommands(std::uint32_t step);
  /// False: the message says something of `node` but comes from another; it is dropped and counted.
  bool speaksFor(const char* topic, const std::string& publisher, const std::string& node);
  const std::map<std::string, std::uint64_t>& refused() const { return refused_; }
  const Authority& authority() const { return authority_; }
  /// In full.
  const std::string& name() const { return name_; }
  /// Subscribes without Nagle's delay; only messages of those who may speak reach the handler.
  template <typename Msg, typename Class>
  ros::Subscriber subscribe(ros::NodeHandle& node, const char* topic, std::uint32_t queue,
                            void (Class::*handler)(const boost::shared_ptr<const Msg>&),
                            Class* object) {
    return subscribeGuarded<Msg>(node, topic, queue,
                                 [handler, object](const ros::MessageEvent<const Msg>& event) {
                                   (object->*handler)(event.getMessage());
                                 });
  }
  /// The same for a handler of the whole event.
  template <typename Msg, typename Handler>
  ros::Subscriber subscribeGuarded(ros::NodeHandle& node, const char* topic, std::uint32_t queue,
                                   Handler handler) {
    const boost::function<void(const ros::MessageEvent<const Msg>&)> guard =
        [this, topic, handler](const ros::MessageEvent<const Msg>& event) {
          if (mayPass(topic, event.getPublisherName())) handler(event);
        };
    return node.subscribe<Msg>(topic, queue, guard, ros::VoidConstPtr(),
                               ros::TransportHints().tcpNoDelay());
  }
  /// For a law: in realtime its handler gets the newest of what waits (see queues.hpp).
  template <typename Msg, typename Class>
  ros::Subscriber subscribeLaw(ros::NodeHandle& node, const char* topic, Pace pace,
                               void (Class::*handler)(const boost::shared_ptr<const Msg>&),
                               Class* object) {
    using Item = boost::shared_ptr<const Msg>;
    const std::uint32_t queue = queueOf(ListenerKind::kLaw, pace);
    if (!answersNewestOnly(pace)) return subscribe(node, topic, queue, handler, object);
    const auto newest = std::make_shared<Newest<Item>>(
        *node.getCallbackQueue(), [handler, object](const Item& msg) { (object->*handler)(msg); });
    return subscribeGuarded<Msg>(
        node, topic, queue,
        [newest](const ros::MessageEvent<const Msg>& event) { newest->put(event.getMessage()); });
  }
  /// The same as subscribe() for a handler that is told who has published.
  template <typename Msg, typename Class>
  ros::Subscriber subscribe(ros::NodeHandle& node, const char* topic, std::uint32_t queue,
                            void (Class::*handler)(const boost::shared_ptr<const Msg>&,
                                                   const std::string& publisher),
                            Class* object) {
    return subscribeGuarded<Msg>(node, topic, queue,
                                 [handler, object](const ros::MessageEvent<const Msg>& event) {
                                   (object->*handler)(event.getMessage(), event.getPublisherName());
                                 });
  }
  /// False: what `publisher` said (by a key of loop.publishers) does not count; it has been counted
  /// and logged.
  bool mayPass(const char* topic, const std::string& publisher);
  /// Advertises a private service; who may not call it (loop.publishers.services) gets
  /// success = false with the reason.
  template <typename Request, typename Response, typename Class>
  ros::ServiceServer serve(ros::NodeHandle& private_node, const char* service,
                           bool (Class::*handler)(Request&, Response&), Class* object) {
    using Asked = ros::ServiceEvent<Request, Response>;
    const boost::function<bool(Asked&)> guard = [this, handler, object](Asked& event) {
      if (mayPass(topics::kServices, event.getCallerName())) {
        Request request = event.getRequest();
        return (object->*handler)(request, event.getResponse());
      }
      event.getResponse().success = false;
      event.getResponse().message = "refused: loop.publishers.services does not name the caller";
      return true;
    };
    return private_node.advertiseService(service, guard);
  }

 private:
  void noteCommand(const std::string& why);
  bool mayLog(const std::string& what);

  std::string name_;
  Authority authority_;
  int exit_code_{0};
  std::map<std::string, std::uint64_t> refused_;
  std::map<std::string, WallThrottle> logs_;  // by topic and reason: one flood silences no other
  std::set<std::string> commands_seen_;       // refused, in words
  std::vector<Event> commands_refused_;       // that nobody has taken yet
  std::string refusal_;                       // the latest
  double refusal_s_{};
};

/// For a node that cannot start: says why on loop_state and the diagnostics, stays long enough to
/// be heard, and returns 1. With ~respawned true its launch would start it again and again on the
/// same text: it stays, failed in words, until `loop_text` has changed.
int failToStart(ros::NodeHandle node, const ros::NodeHandle& private_node, const std::string& why);

/// From now on SIGINT and `rosnode kill` are kept for spinUntilShutdown(). To be called
/// right after ros::init().
void hearShutdown();
/// As ros::spin(); one that is told to end says `last` first, while its topics still are.
void spinUntilShutdown(const std::function<void()>& last);

/// The loop that the launch file gave as text: parameter `loop_text`, searched upwards.
/// @throws InputError if there is none or it is no loop.
LoopFile loopParameter(const ros::NodeHandle& private_node);

/// A node that lives, in a process or a nodelet, or that its loop does not need, which is logged.
/// `Class` has `static std::string idleReason(const LoopFile&)`, empty if the loop needs the node,
/// and a constructor (NodeHandle, private NodeHandle, const LoopFile&).
template <typename Class>
class Running {
 public:
  /// @throws what reading the loop and making the node throw.
  Running(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
          const std::string& name) {
    const LoopFile loop = loopParameter(private_node);
    const std::string idle = Class::idleReason(loop);
    if (!idle.empty()) {
      ROS_INFO("%s: nothing to do: %s", name.c_str(), idle.c_str());
      return;
    }
    watch_.emplace(node, private_node, loop);
    instance_ = std::make_unique<Class>(node, private_node, loop);
  }
  bool needed() const { return instance_ != nullptr; }
  void sayLast() {
    if (instance_) instance_->sayLast();
  }
  /// The exit code of its process.
  int finish() { return instance_ ? instance_->finish() : 0; }

 private:
  std::optional<MasterWatch> watch_;  // lives longer than the node
  std::unique_ptr<Class> instance_;
};

template <typename Class>
int runNode(int argc, char** argv, const std::string& name) {
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  hearShutdown();
  negotiateQuickly();
  const ros::NodeHandle node,
      private_node("~");  // outlives the catch: without a node nothing is logged
  try {
    Running<Class> running(node, private_node, ros::this_node::getName());
    if (running.needed() || private_node.param("stay", false))
      spinUntilShutdown([&running] { running.sayLast(); });
    return running.finish();
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", name.c_str(), error.what());
    return failToStart(node, private_node, error.what());
  }
}

/// Subscribes without Nagle's delay.
template <typename Msg, typename Class>
ros::Subscriber subscribe(ros::NodeHandle& node, const char* topic, std::uint32_t queue,
                          void (Class::*handler)(const boost::shared_ptr<const Msg>&),
                          Class* object) {
  return node.subscribe<Msg>(topic, queue, handler, object, ros::TransportHints().tcpNoDelay());
}

}  // namespace fpc
