#include "runtime/bag_reader.hpp"

#include <fmbpc/CommandEffect.h>
#include <fmbpc/ControlAction.h>
#include <fmbpc/FuzzyModel.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/OperatorState.h>
#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/open_bag.hpp"
#include "ros/operator_commands.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

/// "/ns/" of the one loop in the bag: whatever is before a topic of this name.
std::string spaceOf(const rosbag::Bag& bag, const std::string& file, const std::string& topic) {
  rosbag::View view(bag);
  std::set<std::string> spaces;
  for (const auto* connection : view.getConnections()) {
    const std::string& name = connection->topic;
    const bool ends = name.size() > topic.size() &&
                      name.compare(name.size() - topic.size(), topic.size(), topic) == 0 &&
                      name[name.size() - topic.size() - 1] == '/';
    if (ends) spaces.insert(name.substr(0, name.size() - topic.size()));
  }
  require(!spaces.empty(), file, "a bag of loop.launch record:=true: there is no topic " + topic);
  require(spaces.size() == 1, file,
          "one loop, got " + topic + " below " + join({spaces.begin(), spaces.end()}));
  return *spaces.begin();
}

/// Collects the messages of one run in the order of the bag.
class Reader {
 public:
  Reader(const LoopFile& loop, std::string file) : loop_(loop), file_(std::move(file)) {}

  RecordedRun read(const rosbag::Bag& bag, int run) {
    const std::string space = spaceOf(bag, file_, topics::kMeasurement);
    const auto topic = [&](const char* name) { return space + name; };
    choose(bag, topic(topics::kMeasurement), run);
    rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{
                               topic(topics::kMeasurement), topic(topics::kBaseAction),
                               topic(topics::kControlAction), topic(topics::kSetpointEffect),
                               topic(topics::kOperatorState), topic(topics::kFuzzyModel)}));
    for (const rosbag::MessageInstance& item : view) {
      const std::string name = item.getTopic().substr(space.size());
      if (const auto msg = item.instantiate<fmbpc::Measurement>()) take(*msg);
      if (const auto msg = item.instantiate<fmbpc::ControlAction>())
        take(*msg, name == topics::kBaseAction);
      if (const auto msg = item.instantiate<fmbpc::CommandEffect>()) take(*msg);
      if (const auto msg = item.instantiate<fmbpc::OperatorState>()) take(*msg);
      if (const auto msg = item.instantiate<fmbpc::FuzzyModel>())
        take(*msg, static_cast<std::int64_t>(item.getTime().toNSec()));
    }
    bringAlong();
    return std::move(run_);
  }

 private:
  /// By their numbers, which grow: with simulated time a bag mixes its runs.
  void choose(const rosbag::Bag& bag, const std::string& topic, int run) {
    std::set<std::uint64_t> runs;
    rosbag::View view(bag, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& item : view)
      if (const auto msg = item.instantiate<fmbpc::Measurement>()) runs.insert(msg->run_id);
    require(!runs.empty(), file_, "measurements of this version's messages");
    const std::string number = std::to_string(runs.size());
    require(run > 0 || runs.size() == 1, file_,
            "one run, got " + number +
                ": the plant was started or reset while recording; fmbpc replay --run N takes one");
    require(run <= static_cast<int>(runs.size()), file_,
            "run " + std::to_string(run) + ", got " + number + " of them");
    chosen_ = *std::next(runs.begin(), std::max(run, 1) - 1);
  }

  /// What stood before the run began, unless it says something else itself.
  void bringAlong() {
    if (operator_before_)
      run_.operator_state.emplace_hint(run_.operator_state.begin(), 0,
                                       std::move(operator_before_->second));
    if (model_before_)
      run_.models.emplace_hint(run_.models.begin(), 0, std::move(model_before_->second));
  }

  template <typename Item>
  bool ofBefore(std::uint64_t run_id, std::optional<std::pair<std::uint64_t, Item>>& before,
                const Item& item) const {
    if (run_id < chosen_ && (!before || run_id >= before->first)) before.emplace(run_id, item);
    return run_id != chosen_;
  }

  void take(const fmbpc::Measurement& msg) {
    if (msg.run_id != chosen_) return;
    run_.measurements.emplace(msg.step, fromMsg(msg));
    newest_ = run_.measurements.rbegin()->first + 1;
  }

  void take(const fmbpc::ControlAction& msg, bool base) {
    if (msg.run_id != chosen_) return;
    if (base)
      run_.base.emplace(msg.step, fromMsg(msg));
    else
      run_.control.emplace(msg.step, fromMsg(msg));
  }

  void take(const fmbpc::CommandEffect& msg) {
    if (msg.run_id != chosen_ || !msg.refused.empty()) return;
    CommandEffect effect = fromMsg(msg);
    effect.command.time_ns = 0;
    run_.setpoints.emplace(msg.step, std::move(effect.command));
  }

  /// What was asked after sample k acts from k + 1 on; what was asked before the first, from it on.
  void take(const fmbpc::OperatorState& msg) {
    if (ofBefore(msg.run_id, operator_before_, operatorStateOf(msg))) return;
    const std::int64_t t = fromStamp(msg.header.stamp);
    const auto answered = std::find_if(run_.measurements.begin(), run_.measurements.end(),
                                       [t](const auto& m) { return m.second.header.time_ns >= t; });
    const bool first = run_.operator_state.empty();
    const std::uint32_t step = answered == run_.measurements.end() ? newest_ : answered->first + 1;
    run_.operator_state.emplace(first ? 0 : step, operatorStateOf(msg));
  }

  /// In lockstep from the sample after the one it was made from, else when it came: before sample 0
  /// if not later than that (the bag has no order within one time of /clock).
  void take(const fmbpc::FuzzyModel& msg, std::int64_t came_ns) {
    const TsModel model = matchToLoop(fromMsg(msg), loop_);
    if (msg.run_id != 0 && ofBefore(msg.run_id, model_before_, model)) return;
    const bool at_start =
        run_.measurements.empty() || came_ns <= run_.measurements.begin()->second.header.time_ns;
    const std::uint32_t made = msg.run_id == 0 ? 0 : msg.step + 1;
    const bool exact = msg.run_id != 0 && loop_.exchange.pace == Pace::kLockstep;
    run_.models.emplace(exact || at_start ? made : std::max(made, newest_), model);
  }

  const LoopFile& loop_;
  std::string file_;
  RecordedRun run_;
  std::uint64_t chosen_{};
  std::optional<std::pair<std::uint64_t, OperatorState>> operator_before_;  // with their run
  std::optional<std::pair<std::uint64_t, TsModel>> model_before_;
  std::uint32_t newest_{};  // the step after the newest measurement so far
};

}  // namespace

std::string loopTextOf(const std::string& bag) {
  return withBag(bag, [&](const rosbag::Bag& open) {
    const std::string topic = spaceOf(open, bag, topics::kLoopText) + topics::kLoopText;
    rosbag::View view(open, rosbag::TopicQuery(topic));
    std::set<std::string> texts;
    for (const rosbag::MessageInstance& item : view)
      if (const auto msg = item.instantiate<std_msgs::String>()) texts.insert(msg->data);
    require(texts.size() == 1, bag, "the text of one loop");
    return *texts.begin();
  });
}

RecordedRun readBagRun(const std::string& bag, const LoopFile& loop, int run) {
  return withBag(bag, [&](const rosbag::Bag& open) { return Reader(loop, bag).read(open, run); });
}

}  // namespace fpc
