#include "runtime/operator_line.hpp"

#include <fmbpc/Candidate.h>
#include <fmbpc/CommandEffect.h>
#include <fmbpc/CommissionActionFeedback.h>
#include <fmbpc/CommissionActionGoal.h>
#include <fmbpc/CommissionActionResult.h>
#include <fmbpc/ControlAction.h>
#include <fmbpc/Disturbance.h>
#include <fmbpc/LoopState.h>
#include <fmbpc/ManualInput.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/Setpoint.h>
#include <fmbpc/Tracking.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatus.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "config/disturbance_source.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/node.hpp"
#include "ros/quick_negotiation.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kAnswerPatience = 5.0;     // [s] of wall time, for answers of nodes that live
constexpr std::uint32_t kAnswerIsLost = 3;  // samples after which a command is said again
constexpr double kOnItsWay = 0.02;          // [s], for what was sent before a service answered
constexpr char kControllerName[] = "fmbpc_controller";
constexpr double kLookAfter = 0.5;     // [s] whether the controller lives
constexpr double kLostPatience = 2.0;  // [s] for a result that is on its way
using Show = std::function<void(const std::string&, const std::string&)>;

/// Of a node, as the master has it; empty: the master does not answer, or has none of this name.
std::string addressOf(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = node;
  if (!ros::master::execute("lookupNode", request, response, payload, false)) return {};
  return payload.getType() == XmlRpc::XmlRpcValue::TypeString ? std::string(payload) : "";
}

/// The latest message of a topic, of those that count.
template <typename Msg>
class Latest {
 public:
  Latest(
      ros::NodeHandle& node, const std::string& topic,
      std::function<bool(const Msg&)> counts = [](const Msg&) { return true; })
      : counts_(std::move(counts)),
        subscriber_(node.subscribe<Msg>(
            topic, 1000,
            [this](const boost::shared_ptr<const Msg>& msg) {
              if (counts_(*msg)) latest_ = msg;
            },
            ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay())) {}
  const Msg* get() const { return latest_.get(); }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  std::function<bool(const Msg&)> counts_;
  boost::shared_ptr<const Msg> latest_;
  ros::Subscriber subscriber_;
};

/// A stamp before every sample, so that the command acts as soon as it can, and no two are alike.
ros::Time uniqueStamp() {
  static std::uint32_t number = 0;
  const auto now = static_cast<std::uint32_t>(ros::WallTime::now().toNSec() % 999'000'000U);
  return ros::Time(0, 1 + (now + ++number) % 999'000'000U);
}

std::string shown(double value, const std::string& unit) {
  return exactText(value) + (unit.empty() || unit == "-" ? "" : " " + unit);
}

const char* signedOffset(bool offset, double value) { return offset && value >= 0.0 ? "+" : ""; }

class Line {
 public:
  Line()
      : loop_(loopParameter(ros::NodeHandle("~"))),
        measurement_(node_, topics::kMeasurement),
        summary_(node_, topics::kLoopState,  // the plant speaks for the loop
                 [](const fmbpc::LoopState& msg) { return msg.summary != 0; }) {}

  std::string run(const OperatorCommand& c) {
    switch (c.verb) {
      case OperatorVerb::kSet:
        return command<fmbpc::Setpoint>(topics::kSetpoint, topics::kSetpointEffect, c);
      case OperatorVerb::kDisturb:
        return command<fmbpc::Disturbance>(topics::kDisturbance, topics::kDisturbanceEffect, c);
      case OperatorVerb::kRelease:
        return release(c.names);
      case OperatorVerb::kShadow:
      case OperatorVerb::kHandOver:
      case OperatorVerb::kBack:
        return candidate(c);
      case OperatorVerb::kManual:
      case OperatorVerb::kAuto:
        break;
    }
    return hand(c);
  }

  std::string commission(const CommissionWish& wish, const Show& show) {
    const std::string action = std::string(kControllerName) + "/" + topics::kCommission;
    fmbpc::CommissionActionGoal goal;
    goal.goal_id.stamp = uniqueStamp();
    goal.goal_id.id = ros::this_node::getName() + "-" + std::to_string(goal.goal_id.stamp.nsec);
    goal.goal.brief = wish.brief;
    goal.goal.folder = wish.folder;
    goal.goal.until = wish.until;
    goal.goal.again = wish.again;
    goal.goal.evaluations = static_cast<std::uint32_t>(wish.evaluations);
    goal.goal.members = static_cast<std::uint32_t>(wish.members);
    Latest<fmbpc::CommissionActionResult> result(node_, action + "/result", [&](const auto& msg) {
      return msg.status.goal_id.id == goal.goal_id.id;
    });
    const ros::Subscriber feedback = node_.subscribe<fmbpc::CommissionActionFeedback>(
        action + "/feedback", 100,
        [&](const boost::shared_ptr<const fmbpc::CommissionActionFeedback>& msg) {
          if (msg->status.goal_id.id == goal.goal_id.id)
            show(msg->feedback.stage, msg->feedback.text);
        });
    const ros::Publisher publisher =
        node_.advertise<fmbpc::CommissionActionGoal>(action + "/goal", 1);
    require(wait([&] { return result.connected() && publisher.getNumSubscribers() > 0; },
                 kAnswerPatience),
            action, "a controller of a running loop that takes it");
    publisher.publish(goal);
    // A controller that ends may be back at once, by another address: it has forgotten the goal.
    const std::string controller = ros::names::resolve(kControllerName),
                      address = addressOf(controller);
    for (double lost_s = 0.0; !result.get();) {
      wait([&] { return result.get() != nullptr; }, kLookAfter);
      if (lost_s > 0.0 || addressOf(controller) != address) lost_s += kLookAfter;
      require(ros::ok() && lost_s < kLostPatience, action,
              "a controller that lives; what is done is kept, and the same command goes on");
    }
    const fmbpc::CommissionActionResult& done = *result.get();
    require(done.status.status == actionlib_msgs::GoalStatus::SUCCEEDED, topics::kCommission,
            done.result.message.empty() ? done.status.text : done.result.message);
    return done.result.figures;
  }

 private:
  /// False if it did not come true in time.
  template <typename Condition>
  bool wait(Condition condition, double seconds) {
    const double end_s = steadyNow() + seconds;
    while (!condition()) {
      if (!ros::ok() || steadyNow() > end_s) return false;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return true;
  }

  /// [s] of wall time within which the next sample should come.
  double patience() const {
    const bool by_clock = loop_.exchange.pace != Pace::kLockstep;
    return kAnswerPatience +
           (by_clock ? 2.0 * loop_.simulation.sample_time_s / loop_.exchange.speedup : 0.0);
  }

  std::string state() const {
    const fmbpc::LoopState* s = summary_.get();
    return s ? "the loop is " + s->word + ": " + s->reason : "the plant does not answer";
  }

  std::string since(std::uint32_t step) const {
    return " since sample " + std::to_string(step) + " (" +
           shortText(step * loop_.simulation.sample_time_s / 3600.0) + " h)";
  }

  std::string unitOf(const std::string& name) const {
    const std::string bare = name.substr(name.rfind('/') + 1);  // input/q_r
    for (const auto* list : {&loop_.plant_info.outputs, &loop_.plant_info.inputs})
      for (const SignalInfo& signal : *list)
        if (signal.name == bare) return signal.unit;
    for (const Quantity& q : disturbancesOf(loop_))
      if (q.name == bare) return q.unit;
    return "";
  }

  /// Publishes until the node that takes it says what became of it.
  template <typename Msg>
  fmbpc::CommandEffect ask(const char* topic, const char* answers, Msg msg) {
    msg.header.stamp = uniqueStamp();
    Latest<fmbpc::CommandEffect> effect(
        node_, answers, [&](const fmbpc::CommandEffect& e) { return e.asked == msg.header.stamp; });
    require(wait([&] { return effect.connected() && measurement_.get(); }, kAnswerPatience), topic,
            std::string("a loop that takes it: nobody publishes ") +
                (effect.connected() ? topics::kMeasurement : answers));
    const ros::Publisher publisher = node_.advertise<Msg>(topic, 10, true);
    const double end_s = steadyNow() + patience();
    const auto answered = [&] { return effect.get() != nullptr; };
    std::uint32_t sent = 0;
    for (bool first = true; !answered(); first = false) {
      const fmbpc::Measurement& now = *measurement_.get();
      if (first || now.step >= sent + kAnswerIsLost || now.step < sent) {
        publisher.publish(msg);
        sent = now.step;
      }
      if (wait(answered, 0.2)) break;
      require(!measurement_.get()->final, topic, "a run that is not over (" + state() + ")");
      require(steadyNow() < end_s, topic,
              "a sample within " + shortText(patience()) + " s (" + state() +
                  "); it acts at the next one");
    }
    if (!effect.get()->refused.empty())
      throw InputError(std::string(topic) + " refused: " + effect.get()->refused);
    return *effect.get();
  }

  template <typename Msg>
  std::string command(const char* topic, const char* answers, const OperatorCommand& c) {
    Msg msg;
    msg.mode = c.offset ? Msg::OFFSET : Msg::OVERRIDE;
    for (const auto& [name, value] : c.values) {
      msg.name.push_back(name);
      msg.value.push_back(value);
    }
    Latest<fmbpc::Tracking> tracking(node_, topics::kTracking);
    const fmbpc::CommandEffect effect = ask(topic, answers, msg);
    std::string words;
    for (const auto& [name, value] : c.values)
      words += name + ": " + topic + " " + signedOffset(c.offset, value) +
               shown(value, unitOf(name)) + since(effect.step) + "\n";
    if (c.verb == OperatorVerb::kSet && !c.offset) words += clampedWords(c, effect.step, tracking);
    return words;
  }

  /// What the loop follows instead.
  std::string clampedWords(const OperatorCommand& c, std::uint32_t step,
                           const Latest<fmbpc::Tracking>& tracking) {
    if (!wait([&] { return tracking.get() && tracking.get()->step >= step; }, 1.0)) return "";
    std::string words;
    const auto& outputs = loop_.plant_info.outputs;
    for (std::size_t i = 0; i < std::min(outputs.size(), tracking.get()->setpoint.size()); ++i)
      for (const auto& [name, value] : c.values)
        if (name == outputs[i].name && !(tracking.get()->setpoint[i] == value))
          words += name + ": the loop follows " +
                   shown(tracking.get()->setpoint[i], outputs[i].unit) +
                   " (setpoint.lower, .upper and .rate_per_h of the loop file)\n";
    return words;
  }

  std::string release(const std::vector<std::string>& names) {
    fmbpc::Setpoint setpoint;
    fmbpc::Disturbance disturbance;
    setpoint.mode = disturbance.mode = fmbpc::Setpoint::RELEASE;
    const std::vector<std::string> outputs = namesOf(loop_.plant_info.outputs);
    for (const std::string& name : names) {
      const bool output = std::find(outputs.begin(), outputs.end(), name) != outputs.end();
      (output ? setpoint.name : disturbance.name).push_back(name);
    }
    std::string words;
    if (names.empty() || !setpoint.name.empty())
      words += released("setpoint", ask(topics::kSetpoint, topics::kSetpointEffect, setpoint),
                        names.empty());
    if (!disturbance.name.empty() || (names.empty() && !loop_.external_plant))
      words += released("disturbance",
                        ask(topics::kDisturbance, topics::kDisturbanceEffect, disturbance),
                        names.empty());
    return words;
  }

  std::string released(const std::string& what, const fmbpc::CommandEffect& effect,
                       bool all) const {
    return (all ? "every " + what : join(effect.name) + ": " + what) + " released" +
           since(effect.step) + "\n";
  }

  /// manual and auto: services, in force with the first action that says so.
  std::string hand(const OperatorCommand& c) {
    const bool manual = c.verb == OperatorVerb::kManual;
    Latest<fmbpc::ControlAction> action(node_, topics::kControlAction);
    require(wait([&] { return action.connected() && measurement_.get(); }, kAnswerPatience),
            "manual", "a loop that runs: nobody publishes control_action");
    fmbpc::ManualInput put = byHand(c);
    std_srvs::SetBool on;
    on.request.data = manual;
    call(topics::kManual, on);
    if (!c.values.empty()) call(topics::kManualInput, put);
    wait([] { return false; }, kOnItsWay);
    const std::uint32_t before =
        std::max(measurement_.get()->step, action.get() ? action.get()->step : 0);
    const bool done = wait(
        [&] {
          const fmbpc::ControlAction* a = action.get();
          return a && a->step > before && (a->source == fmbpc::ControlAction::MANUAL) == manual;
        },
        patience());
    require(done, manual ? "manual" : "auto",
            "an action within " + shortText(patience()) + " s (" + state() + ")");
    std::string words = put.response.message.empty() ? "" : put.response.message + "\n";
    words += (manual ? "manual" : "auto") + since(action.get()->step) + "\n";
    if (manual)
      for (std::size_t i = 0; i < loop_.plant_info.inputs.size(); ++i)
        words += loop_.plant_info.inputs[i].name + ": " +
                 shown(action.get()->input.at(i), loop_.plant_info.inputs[i].unit) + "\n";
    return words;
  }

  /// What the controller says of its candidate, in JSON.
  static std::string candidate(const OperatorCommand& c) {
    using Request = fmbpc::Candidate::Request;
    fmbpc::Candidate ask;
    ask.request.loop = c.loop;
    ask.request.order = c.verb == OperatorVerb::kHandOver ? Request::HAND_OVER
                        : c.verb == OperatorVerb::kBack   ? Request::BACK
                        : c.loop.empty()                  ? Request::REPORT
                                                          : Request::WATCH;
    call(topics::kCandidate, ask);
    return ask.response.message + "\n";
  }

  /// Inputs that are not named stay where they are.
  fmbpc::ManualInput byHand(const OperatorCommand& c) const {
    fmbpc::ManualInput put;
    put.request.input = measurement_.get()->input_applied;
    const std::vector<std::string> inputs = namesOf(loop_.plant_info.inputs);
    for (const auto& [name, value] : c.values) {
      const auto at = std::find(inputs.begin(), inputs.end(), name);
      require(at != inputs.end(), "input '" + name + "'", "one of " + join(inputs));
      put.request.input.at(static_cast<std::size_t>(at - inputs.begin())) = value;
    }
    return put;
  }

  template <typename Service>
  static void call(const char* name, Service& service) {
    const std::string full = std::string(kControllerName) + "/" + name;
    require(ros::service::call(full, service), full, "a controller that answers");
    if (!service.response.success)
      throw InputError(std::string(name) + " refused: " + service.response.message);
  }

  ros::NodeHandle node_;
  LoopFile loop_;
  Latest<fmbpc::Measurement> measurement_;
  Latest<fmbpc::LoopState> summary_;
};

}  // namespace

namespace {

void beOperator() {
  ros::init(ros::M_string{}, "operator",
            ros::init_options::AnonymousName | ros::init_options::NoRosout);
  require(ros::master::check(), "ROS_MASTER_URI",
          "a master at " + ros::master::getURI() +
              ": start a loop first (roslaunch fmbpc loop.launch loop:=NAME)");
  negotiateQuickly();
}

}  // namespace

std::string askLoop(const OperatorCommand& command) {
  beOperator();
  return Line().run(command);
}

std::string commissionLoop(const CommissionWish& wish, const Show& show) {
  beOperator();
  return Line().commission(wish, show);
}

}  // namespace fpc
