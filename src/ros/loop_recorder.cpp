#include "ros/loop_recorder.hpp"

#include <std_msgs/String.h>

#include <algorithm>

#include "fmbpc/base/text.hpp"
#include "fmbpc/loop/plot.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kPollPeriod = 0.05;   // [s] of wall time
constexpr double kLastWords = 0.3;     // [s] between run_end and the end of this process
constexpr double kHeard = 1.0;         // [s] in which a run under way is heard of
constexpr double kLookForRing = 0.01;  // [s] of wall time, at who is there
constexpr double kSettled = 0.1;       // [s]: a connection is complete at both ends a moment later

}  // namespace

LoopRecorder::LoopRecorder(ros::NodeHandle node, const ros::NodeHandle& private_node,
                           const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      keep_(private_node.param("keep", false)),
      plot_(private_node.param("plot", true)),
      stay_(private_node.param("stay", false)),
      started_s_(steadyNow()),
      store_(openStore(private_node.param<std::string>("out", ""))),
      session_(recordLayout(loop), [this](const SampleRecord& sample) { store_->append(sample); }),
      ready_(node, loop, name()),
      plant_(loop),
      recorded_(node.advertise<std_msgs::String>(topics::kRecorded, 1, true)),
      end_(node),
      poll_timer_(guardedTimer(node, kPollPeriod, "poll", [this] { poll(); })),
      ready_timer_(guardedTimer(node, kLookForRing, "ready", [this] { announceIfConnected(); })),
      health_(node, private_node, "recorder", loop.name, false,
              {[this](double now_s) { return health(now_s); }, [this] { return session_.latest(); },
               [this](Diagnostics::Status& status) { report(status); }}) {
  const auto listen = [&](const char* topic, auto handler) {
    ring_.push_back(subscribe(node, topic, queueOf(ListenerKind::kRecord), handler, this));
  };
  listen(topics::kPlantInfo, &LoopRecorder::onPlantInfo);
  listen(topics::kMeasurement, &LoopRecorder::onMeasurement);
  listen(topics::kTracking, &LoopRecorder::onTracking);
  listen(topics::kControlAction, &LoopRecorder::onAction);
  if (!loop.external_plant) listen(topics::kPlantState, &LoopRecorder::onState);
  if (loop.has_clp) {
    listen(topics::kBaseAction, &LoopRecorder::onBase);
    listen(topics::kSolverReport, &LoopRecorder::onReport);
  }
  if (unusable_.empty()) return;
  ROS_FATAL("%s: %s", name().c_str(), unusable_.c_str());
  problem_ = unusable_;
  health_.look();
}

std::unique_ptr<RecordStore> LoopRecorder::openStore(const std::string& folder) {
  try {
    return std::make_unique<RecordStore>(loop_, folder);
  } catch (const InputError& error) {
    unusable_ = std::string("cannot record: ") + error.what();
    return std::make_unique<RecordStore>(loop_, "");
  }
}

void LoopRecorder::poll() {
  if (!stay_ && ending_s_ >= 0 && steadyNow() - ending_s_ > kLastWords)
    return problem_.empty() ? done() : fail(problem_);
  if (!unusable_.empty()) return giveUp();
  store_->flush();
  if (written_) return;
  if (clock_.closed()) return conclude();  // the disk had no room
  if (!clock_.stragglersLost(steadyNow())) return;
  problem_ = "the final sample came, but the record has gaps: " + join(session_.gaps());
  session_.close();
  conclude();
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
void LoopRecorder::announceIfConnected() {
  const bool connected = std::all_of(ring_.begin(), ring_.end(),
                                     [](const auto& s) { return s.getNumPublishers() > 0; });
  if (!connected || !plant_.open() || !unusable_.empty()) {
    connected_s_ = -1;
    return;
  }
  if (connected_s_ < 0) connected_s_ = steadyNow();
  const bool gated = !loop_.external_plant || loop_.gateway.enabled();
  if (!gated && steadyNow() - connected_s_ < kSettled) return;
  ready_.announce();
  ready_timer_.stop();
}

void LoopRecorder::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    const std::uint64_t before = plant_.runId();
    if (plant_.introduce(*msg) && plant_.runId() != before) beginRun(plant_.runId());
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
  if (here > 0) {
    clock_.restart(std::min(store_->beganAt(), steadyNow()));
    session_.resume(run_id, here);
    ROS_INFO("loop_recorder: goes on after the %u samples that are on disk", here);
  } else {
    session_.announce(run_id);
  }
}

// Any message of the first sample may come first, and any of the last one may be the last.
template <typename Take>
void LoopRecorder::record(const char* topic, Take take) {
  if (!unusable_.empty()) {
    run_under_way_ = true;
    return;
  }
  guarded(topic, [&] {
    clock_.hear(steadyNow());
    take();
    if (!written_ && !clock_.closed() && session_.complete()) conclude();
  });
}

void LoopRecorder::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  record(topics::kMeasurement, [&] {
    session_.receive(fromMsg(*msg));
    clock_.seeFinal(session_.finalSeen(), steadyNow());
  });
}

void LoopRecorder::onState(const fmbpc::PlantState::ConstPtr& msg) {
  record(topics::kPlantState, [&] { session_.receive(fromMsg(*msg), msg->remark); });
}

void LoopRecorder::onTracking(const fmbpc::Tracking::ConstPtr& msg) {
  record(topics::kTracking, [&] { session_.receive(fromMsg(*msg), msg->remark); });
}

void LoopRecorder::onBase(const fmbpc::ControlAction::ConstPtr& msg) {
  record(topics::kBaseAction, [&] { session_.receiveBase(fromMsg(*msg)); });
}

void LoopRecorder::onAction(const fmbpc::ControlAction::ConstPtr& msg) {
  record(topics::kControlAction, [&] { session_.receiveAction(fromMsg(*msg)); });
}

void LoopRecorder::onReport(const fmbpc::SolverReport::ConstPtr& msg) {
  record(topics::kSolverReport, [&] { session_.receive(fromMsg(*msg)); });
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

// Everybody else who ends with the run hears it before this process goes.
void LoopRecorder::end() {
  if (keep_ || ending_s_ >= 0) return;
  ending_s_ = steadyNow();
  end_.say(problem_.empty() ? "recorded" : problem_);
}

bool LoopRecorder::tryWrite() {
  try {
    const Summary summary = store_->finish(clock_.elapsed(steadyNow()));
    written_ = true;
    trouble_ = troubleOf(summary);
    ROS_INFO("loop_recorder: %u samples in %.3f s", summary.steps, summary.wall_s);
  } catch (const std::exception& error) {
    problem_ = error.what();
    return false;
  }
  if (session_.complete()) problem_ = trouble_;
  if (!store_->folder().empty()) {
    const PlotResult plot = plot_ ? drawPlot(store_->written()) : PlotResult{};
    if (!plot.warning.empty()) ROS_WARN("loop_recorder: %s", plot.warning.c_str());
    ROS_INFO("loop_recorder: written: %s", store_->written().c_str());
  }
  std_msgs::String folder;
  folder.data = store_->written();
  if (ros::ok() && session_.complete()) recorded_.publish(folder);
  return true;
}

int LoopRecorder::finish() {
  const int code = written_ && !problem_.empty() ? 1 : Node::finish();
  if (code != 0 || written_ || !session_.running()) {
    if (code == 0 && !written_) ROS_WARN("loop_recorder: stopped before the first sample");
    return code == 0 && !written_ ? 1 : code;
  }
  session_.close();
  if (!tryWrite()) {
    ROS_ERROR("loop_recorder: %s", problem_.c_str());
    return 1;
  }
  if (loop_.simulation.samples == 0) return 0;
  ROS_ERROR("loop_recorder: stopped before the final sample: what came until then is written");
  return 1;
}

Health LoopRecorder::health(double) const {
  if (!plant_.problem().empty()) return {LoopMode::kFailed, plant_.problem(), {}};
  if (!store_->problem().empty()) return {LoopMode::kFailed, store_->problem(), {}};
  if (!problem_.empty()) return {LoopMode::kFailed, problem_, {}};
  if (!ready_.announced()) return {LoopMode::kStarting, "waiting for publishers of the ring", {}};
  if (written_) return {LoopMode::kFinished, "written", {}};
  if (session_.gapCount() > 0)
    return {LoopMode::kDegraded, "recording, with gaps: " + session_.gaps(1).front(), {}};
  return {LoopMode::kAutomatic, session_.running() ? "recording" : "waiting", {}};
}

void LoopRecorder::report(Diagnostics::Status& status) const {
  status.add("step", session_.latest().step);
  status.add("samples on disk", store_->samples() - store_->unwritten() - store_->lost());
  status.add("samples that wait for the disk", store_->unwritten());
  status.add("samples lost", store_->lost());
  if (!store_->remark().empty()) status.add("run before", store_->remark());
  status.add("samples with gaps", session_.gapCount());
  status.add("waiting for what belongs to them", session_.waiting());
  status.add("dropped: other run", session_.strays());
  status.add("dropped: wrong size or not finite", session_.wrongSize());
  addRefused(status, refused());
  addRefused(status, authority().refused());
}

}  // namespace fpc
