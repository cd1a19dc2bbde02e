#include "ros/loop_recorder.hpp"

#include <std_msgs/String.h>

#include <algorithm>
#include <set>

#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/plot.hpp"
#include "runtime/run_events.hpp"

namespace fpc {
namespace {

constexpr double kRecorderPoll = 0.05;  // [s] of wall time
constexpr double kLastWords = 0.3;      // [s] between run_end and the end of this process
constexpr double kLastMessages = 0.1;   // [s] after the last sample, for the bag
constexpr double kHeard = 1.0;          // [s] in which a run under way is heard of
constexpr double kSettled = 0.1;        // [s]: a connection is complete at both ends a moment later
constexpr double kLookForTopics = 0.1, kLookForMore = 0.5;  // [s], until ready and then
constexpr int kLate = 20;                                   // polls of 0.05 s
constexpr double kPredecessor = 5.0;  // [s] in which one of the same name may end in order

template <typename Msg>
StepHeader sampleOf(const Msg& msg) {
  return {fromStamp(msg.header.stamp), msg.run_id, msg.step};
}

}  // namespace

// What is said of a sample is in the bag before the sample counts as recorded.
template <typename Msg>
void LoopRecorder::listen(ros::NodeHandle& node, const char* topic, Handler<Msg> handler) {
  ring_.push_back(subscribeGuarded<Msg>(
      node, topic, queueOf(ListenerKind::kRecord), [=](const ros::MessageEvent<const Msg>& event) {
        if (bag_) bag_->take(topic, event);
        (this->*handler)(*event.getMessage(), event.getPublisherName());
      }));
  publishers_.alsoHear(ring_.back());
}

LoopRecorder::LoopRecorder(ros::NodeHandle node, const ros::NodeHandle& private_node,
                           const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      keep_(private_node.param("keep", false)),
      plot_(private_node.param("plot", true)),
      stay_(private_node.param("stay", false)),
      started_s_(steadyNow()),
      store_(openStore(private_node.param<std::string>("out", ""))),
      session_(
          recordLayout(loop),
          [this](std::uint32_t step, const SampleRecord& sample) { store_->put(step, sample); }),
      ready_(node, loop, name(), [this] { return isConnected(); }),
      plant_(loop),
      recorded_(node.advertise<std_msgs::String>(topics::kRecorded, 1, true)),
      sample_recorded_(
          node.advertise<fmbpc::Recorded>(topics::kSampleRecorded, queueOf(ListenerKind::kPeer))),
      end_(node),
      poll_timer_(guardedTimer(node, kRecorderPoll, "poll", [this] { poll(); }).started()),
      health_(node, private_node, "recorder", loop.name, false,
              {[this](double now_s) { return health(now_s); }, [this] { return session_.latest(); },
               [this](Diagnostics::Status& status) { report(status); }}) {
  std::set<std::string> exchange{topics::kPlantInfo, topics::kMeasurement, topics::kTracking,
                                 topics::kControlAction};
  if (!loop.external_plant) exchange.insert(topics::kPlantState);
  if (loop.has_clp) exchange.insert({topics::kBaseAction, topics::kSolverReport});
  const std::string bag = private_node.param<std::string>("bag", "");
  if (unusable_.empty() && !bag.empty())
    bag_ = std::make_unique<BagWriter>(node, bag, loop.resolved, exchange);
  listen(node, topics::kPlantInfo, &LoopRecorder::onPlantInfo);
  listen(node, topics::kMeasurement, &LoopRecorder::onMeasurement);
  listen(node, topics::kTracking, &LoopRecorder::onTracking);
  listen(node, topics::kControlAction, &LoopRecorder::onAction);
  if (!loop.external_plant) listen(node, topics::kPlantState, &LoopRecorder::onState);
  if (loop.has_clp) {
    listen(node, topics::kBaseAction, &LoopRecorder::onBase);
    listen(node, topics::kSolverReport, &LoopRecorder::onReport);
  }
  if (unusable_.empty()) return;
  ROS_FATAL("%s: %s", name().c_str(), unusable_.c_str());
  problem_ = unusable_;
  health_.look();
}

std::unique_ptr<RecordStore> LoopRecorder::openStore(const std::string& folder) {
  try {
    return std::make_unique<RecordStore>(loop_, folder, kPredecessor);
  } catch (const InputError& error) {
    unusable_ = std::string("cannot record: ") + error.what();
    return std::make_unique<RecordStore>(loop_, "");
  }
}

void LoopRecorder::poll() {
  if (ending_s_ >= 0 && !said_end_ && steadyNow() - ending_s_ > kLastMessages) sayEnd();
  if (!stay_ && said_end_ && steadyNow() - ending_s_ > kLastWords)
    return problem_.empty() ? done() : fail(problem_);
  if (!unusable_.empty()) return giveUp();
  if (bag_ && !said_end_ &&
      steadyNow() - looked_s_ >= (bag_ready_ ? kLookForMore : kLookForTopics)) {
    bag_ready_ = bag_->look() || bag_ready_;
    looked_s_ = steadyNow();
  }
  if (!written_) watchGaps();
  if (store_->flush(session_.incomplete(told_, session_.latest().step).empty()) && bag_)
    bag_->beginNextPart();
  store_->sync(steadyNow());
  if (bag_) bag_->sync(steadyNow());
  if (written_) return;
  if (clock_.closed()) return conclude();  // the disk had no room
  if (!clock_.stragglersLost(steadyNow())) return;
  const std::uint32_t last = session_.latest().step, expected = session_.layout().samples;
  problem_ = expected != 0 && expected != last
                 ? "the plant called sample " + std::to_string(last) + " the last; the loop's is " +
                       std::to_string(expected)
                 : "the final sample came, but the record has gaps: " + join(session_.gaps());
  session_.close();
  conclude();
}

// What lacks something is on disk as well, and amended by what still comes. A sample that lacks it
// for a second is a gap, which is said once; the loop is worse for it while the newest lack it.
void LoopRecorder::watchGaps() {
  session_.keep();
  const std::uint32_t now = session_.latest().step;
  if (!session_.lacks()) {
    lacks_s_ = -1;
  } else {
    const auto [step, what] = session_.incomplete(now - 1, now).front();
    lacks_ = "sample " + std::to_string(step) + ": no " + what;
    if (lacks_s_ < 0) lacks_s_ = steadyNow();
  }
  if (++polls_ < kLate) return;
  std::vector<Event> gaps;
  for (const auto& [step, what] : session_.incomplete(told_, due_))
    gaps.push_back(gapEvent(what, step));
  health_.say(gaps);
  told_ = due_;
  due_ = now;
  polls_ = 0;
}

// A folder that cannot be used ends the launch before the first sample; a run that is under way
// goes on without this process, which a launch that respawns starts again.
void LoopRecorder::giveUp() {
  if (steadyNow() - started_s_ < kHeard) return;
  if (run_under_way_) return fail(unusable_);
  end();
}

// A plant of ours sends sample 0 only when its own ends of the connections are complete, and so do
// the others their first answers (ListenerGate); for somebody else's plant it has to be waited for.
bool LoopRecorder::isConnected() {
  const bool connected = std::all_of(ring_.begin(), ring_.end(),
                                     [](const auto& s) { return s.getNumPublishers() > 0; });
  if (!connected || !plant_.open() || !unusable_.empty() || (bag_ && !bag_ready_) ||
      !publishers_.connected()) {
    connected_s_ = -1;
    return false;
  }
  if (connected_s_ < 0) connected_s_ = steadyNow();
  const bool gated = !loop_.external_plant || loop_.gateway.enabled();
  return gated || steadyNow() - connected_s_ >= kSettled;
}

void LoopRecorder::onPlantInfo(const fmbpc::PlantInfo& msg, const std::string& publisher) {
  guarded(topics::kPlantInfo, [&] {
    const std::uint64_t before = plant_.runId();
    if (!plant_.introduce(msg) || plant_.runId() == before) return;
    announcer_ = publisher;
    beginRun(plant_.runId());
  });
}

// What there is of an unfinished run before is set aside, not lost.
void LoopRecorder::beginRun(std::uint64_t run_id) {
  if (session_.running() && !written_) session_.close();
  written_ = false;
  clock_.restart();
  problem_ = unusable_;
  const std::uint32_t here = store_->begin(run_id);
  if (!store_->problem().empty())
    ROS_ERROR("loop_recorder: %s (tried again)", store_->problem().c_str());
  if (!store_->remark().empty()) ROS_WARN("loop_recorder: %s", store_->remark().c_str());
  if (bag_) bag_->begin(run_id);
  told_ = due_ = here;
  if (here > 0) {
    clock_.restart(std::min(store_->beganAt(), steadyNow()));
    session_.resume(run_id, here, store_->unfinished());
    ROS_INFO("loop_recorder: goes on after the %u samples that are on disk", here);
  } else {
    session_.announce(run_id);
  }
}

// Any message of the first sample may come first, and any of the last one may be the last.
template <typename Msg, typename Take>
void LoopRecorder::record(const char* topic, const Msg& msg, Take take) {
  if (!unusable_.empty()) {
    run_under_way_ = true;
    return;
  }
  guarded(topic, [&] {
    clock_.hear(steadyNow());
    take();
    acknowledge(sampleOf(msg));
    if (!written_ && !clock_.closed() && session_.complete()) conclude();
  });
}

// Also again, for a plant that has not heard it.
void LoopRecorder::acknowledge(const StepHeader& sample) {
  if (!session_.holds(sample)) return;
  fmbpc::Recorded msg;
  msg.header.stamp = toStamp(sample.time_ns);
  msg.run_id = sample.run_id;
  msg.step = sample.step;
  sample_recorded_.publish(msg);
}

// Where anyone may be the plant, only who announced the run says what it measured and when it ends.
void LoopRecorder::onMeasurement(const fmbpc::Measurement& msg, const std::string& publisher) {
  record(topics::kMeasurement, msg, [&] {
    require(msg.run_id != plant_.runId() || publisher == announcer_, "measurement of " + publisher,
            "one of " + announcer_ + ", which announced the run");
    session_.receive(fromMsg(msg));
    clock_.seeFinal(session_.finalSeen(), steadyNow());
  });
}

void LoopRecorder::onState(const fmbpc::PlantState& msg, const std::string&) {
  record(topics::kPlantState, msg, [&] { session_.receive(fromMsg(msg), fromMsg(msg.events)); });
}

void LoopRecorder::onTracking(const fmbpc::Tracking& msg, const std::string&) {
  record(topics::kTracking, msg, [&] { session_.receive(fromMsg(msg), fromMsg(msg.events)); });
}

void LoopRecorder::onBase(const fmbpc::ControlAction& msg, const std::string&) {
  record(topics::kBaseAction, msg, [&] { session_.receiveBase(fromMsg(msg)); });
}

void LoopRecorder::onAction(const fmbpc::ControlAction& msg, const std::string&) {
  record(topics::kControlAction, msg, [&] { session_.receiveAction(fromMsg(msg)); });
}

void LoopRecorder::onReport(const fmbpc::SolverReport& msg, const std::string&) {
  record(topics::kSolverReport, msg, [&] { session_.receive(fromMsg(msg)); });
}

// Writes the files; a disk without room gets some time, the journal stays whatever happens.
void LoopRecorder::conclude() {
  clock_.close(steadyNow());
  if (!tryWrite()) {
    if (clock_.writingLost(steadyNow())) end();
    return;
  }
  health_.look();
  end();
}

// The bag is whole first: what came with the last sample is still to be written to it.
void LoopRecorder::end() {
  if (keep_ || ending_s_ >= 0) return;
  ending_s_ = steadyNow();
  if (!bag_) sayEnd();
}

// Everybody else who ends with the run hears it before this process goes.
void LoopRecorder::sayEnd() {
  if (bag_) bag_->close();
  if (bag_ && problem_.empty()) problem_ = bag_->problem();
  said_end_ = true;
  ending_s_ = steadyNow();
  end_.say(problem_.empty() ? "recorded" : problem_);
}

bool LoopRecorder::tryWrite() {
  try {
    const double wall_s = clock_.elapsed(steadyNow());
    session_.close();
    const Summary summary = clock_.closed() ? store_->finish(wall_s) : store_->interrupt(wall_s);
    written_ = true;
    trouble_ = troubleOf(summary);
    ROS_INFO("loop_recorder: %u samples in %.3f s", summary.steps, summary.wall_s);
  } catch (const std::exception& error) {
    problem_ = error.what();
    return false;
  }
  if (session_.complete()) problem_ = trouble_;
  if (bag_ && problem_.empty()) problem_ = bag_->problem();
  if (!store_->folder().empty()) {
    const PlotResult plot = plot_ ? drawPlot(store_->folder()) : PlotResult{};
    if (!plot.warning.empty()) ROS_WARN("loop_recorder: %s", plot.warning.c_str());
    ROS_INFO("loop_recorder: written: %s", store_->folder().c_str());
  }
  std_msgs::String folder;
  folder.data = store_->folder();
  if (ros::ok() && session_.complete()) recorded_.publish(folder);
  return true;
}

int LoopRecorder::finish() {
  const int code = writeRest();
  if (bag_) bag_->close();
  return bag_ && !bag_->problem().empty() ? 1 : code;
}

int LoopRecorder::writeRest() {
  const int code = written_ && !problem_.empty() ? 1 : Node::finish();
  if (code != 0 || written_ || !session_.running()) {
    if (code == 0 && !written_) ROS_WARN("loop_recorder: stopped before the first sample");
    return code == 0 && !written_ ? 1 : code;
  }
  if (!tryWrite()) {
    ROS_ERROR("loop_recorder: %s", problem_.c_str());
    return 1;
  }
  if (loop_.simulation.samples == 0) return 0;
  ROS_ERROR("loop_recorder: stopped before the final sample: what came until then is written");
  return 1;
}

template int runNode<LoopRecorder>(int, char**, const std::string&);

}  // namespace fpc
