#include "fmbpc/ros/loop_recorder.hpp"

#include <std_msgs/String.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "fmbpc/loop/plot.hpp"
#include "fmbpc/loop/report.hpp"
#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kPollPeriod = 0.05;  // [s] of wall time
constexpr double kFinalPatience =
    10;  // [s] of wall time for stragglers after the final measurement
constexpr int kPollsConnected =
    3;  // a connection is complete at both ends a moment after it is made
constexpr std::size_t kMostEarly = 10000;

std::vector<std::string> namesOf(const std::vector<SignalInfo>& signals) {
  std::vector<std::string> names;
  names.reserve(signals.size());
  for (const SignalInfo& signal : signals) names.push_back(signal.name);
  return names;
}

Recorder makeRecorder(const LoopFile& loop) {
  std::vector<std::string> names, units;
  if (!loop.external_plant) {
    const auto plant = makePlant(loop.simulation);
    for (const Quantity& state : plant->description().states) {
      names.push_back(state.name);
      units.push_back(state.unit);
    }
  }
  Recorder recorder(loop.name, loop.plant_info, loop.has_clp, !loop.external_plant, names, units);
  recorder.leaveOut(loop.report.without_setpoint);
  return recorder;
}

template <typename List>
Eigen::Index count(const List& list) {
  return static_cast<Eigen::Index>(list.size());
}

}  // namespace

LoopRecorder::LoopRecorder(ros::NodeHandle node, const ros::NodeHandle& private_node,
                           const LoopFile& loop)
    : loop_(loop),
      out_(private_node.param<std::string>("out", "")),
      keep_(private_node.param("keep", false)),
      plot_(private_node.param("plot", true)),
      recorder_(makeRecorder(loop)),
      setpoints_(node, namesOf(loop.plant_info.outputs)),
      ready_(node),
      plant_(loop.plant_info),
      n_y_(count(loop.plant_info.outputs)),
      n_u_(count(loop.plant_info.inputs)),
      n_d_(count(loop.plant_info.disturbances)),
      recorded_(node.advertise<std_msgs::String>(topics::kRecorded, 1, true)),
      poll_timer_(node.createWallTimer(ros::WallDuration(kPollPeriod),
                                       [this](const ros::WallTimerEvent&) { poll(); })),
      diagnostics_(node, private_node, "recorder", loop.name,
                   [this](Diagnostics::Status& status) { report(status); }) {
  removeOldFiles();
  const auto listen = [&](const char* topic, auto handler) {
    ring_.push_back(subscribe(node, topic, topics::kRingQueue, handler, this));
  };
  listen(topics::kPlantInfo, &LoopRecorder::onPlantInfo);
  listen(topics::kMeasurement, &LoopRecorder::onMeasurement);
  listen(topics::kTracking, &LoopRecorder::onTracking);
  listen(topics::kControlAction, &LoopRecorder::onAction);
  if (!loop.external_plant) listen(topics::kPlantState, &LoopRecorder::onState);
  if (!loop.has_clp) return;
  listen(topics::kBaseAction, &LoopRecorder::onBase);
  listen(topics::kSolverReport, &LoopRecorder::onReport);
}

// Results of an earlier run must not be taken for those of this one.
void LoopRecorder::removeOldFiles() const {
  if (out_.empty()) return;
  for (const char* name : {"summary.json", "trajectory.csv", "plot.png"})
    std::filesystem::remove(std::filesystem::path(out_) / name);
}

void LoopRecorder::poll() {
  if (!ready_.announced()) announceIfConnected();
  if (final_seen_.isZero() || (ros::SteadyTime::now() - final_seen_).toSec() < kFinalPatience)
    return;
  final_seen_ = {};
  fail("the final sample came, but the record has gaps: " + join(recorder_.gaps()));
}

void LoopRecorder::announceIfConnected() {
  const bool connected = std::all_of(ring_.begin(), ring_.end(),
                                     [](const auto& s) { return s.getNumPublishers() > 0; });
  polls_connected_ = connected && plant_.open() ? polls_connected_ + 1 : 0;
  if (polls_connected_ == kPollsConnected) ready_.announce();
}

void LoopRecorder::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(fromMsg(*msg))) return;
    const auto parked = std::exchange(unannounced_, {});
    for (const auto& measurement : parked) onMeasurement(measurement);
  });
}

bool LoopRecorder::fits(const Measurement& m) const {
  return m.outputs.size() == n_y_ && m.disturbances.size() == n_d_ &&
         m.input_applied.size() == n_u_;
}
bool LoopRecorder::fits(const PlantState& s) const {
  const auto& record = recorder_.record();
  return s.outputs.size() == n_y_ && s.state.size() == count(record.states);
}
bool LoopRecorder::fits(const Tracking& t) const {
  return t.setpoint.size() == n_y_ && t.reference.size() == n_y_;
}
bool LoopRecorder::fits(const ControlAction& a) const {
  return a.input.size() == n_u_ && a.input.allFinite();
}
bool LoopRecorder::fits(const SolverReport& r) const { return r.perturbation.size() == n_u_; }

template <typename Item>
void LoopRecorder::collect(const Item& item, bool SampleRecord::*has,
                           void (Recorder::*add)(const Item&)) {
  const StepHeader& header = item.header;
  if (!fits(item)) {
    ++wrong_size_;
    return;
  }
  const bool later_run = !run_known_ || header.run_id > measured_.run_id;
  const bool this_run = run_known_ && header.run_id == measured_.run_id;
  if (later_run || (this_run && header.step > measured_.step)) {
    if (early_.size() < kMostEarly)
      early_.push_back({header, [this, item, has, add] { collect(item, has, add); }});
    else
      ++strays_;
    return;
  }
  if (!this_run || written_) {
    ++strays_;
    return;
  }
  const auto& samples = recorder_.record().samples;
  if (header.step < samples.size() && samples[header.step].*has) return;  // repeated
  (recorder_.*add)(item);
  if (!final_seen_.isZero()) checkComplete();
}

void LoopRecorder::deliverEarly() {
  std::vector<Early> due;
  const auto later = std::stable_partition(early_.begin(), early_.end(), [&](const Early& e) {
    return e.header.run_id < measured_.run_id ||
           (e.header.run_id == measured_.run_id && e.header.step <= measured_.step);
  });
  std::move(early_.begin(), later, std::back_inserter(due));
  early_.erase(early_.begin(), later);
  for (const Early& early : due) early.deliver();
}

void LoopRecorder::beginRun(const StepHeader& header) {
  if (run_known_) {
    setpoints_.clear();
    recorder_.take();  // an unfinished run is forgotten
  }
  run_known_ = true;
  written_ = false;
  final_seen_ = {};
  began_ = ros::SteadyTime::now();
  measured_ = header;
}

void LoopRecorder::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    const Measurement m = fromMsg(*msg);
    if (!fits(m)) {
      ++wrong_size_;
      return;
    }
    if (!plant_.admits(m.header.run_id, ros::WallTime::now())) {
      ++strays_;
      if (unannounced_.size() < kMostEarly) unannounced_.push_back(msg);
      return;
    }
    if (!run_known_ || m.header.run_id > measured_.run_id) beginRun(m.header);
    if (m.header.run_id < measured_.run_id) {
      ++strays_;
      return;
    }
    measured_.step = std::max(measured_.step, m.header.step);
    if (m.final && !written_ && final_seen_.isZero()) final_seen_ = ros::SteadyTime::now();
    setpoints_.advance(m.header.time_ns);
    collect<Measurement>(m, &SampleRecord::has_measurement, &Recorder::add);
    if (!early_.empty()) deliverEarly();
  });
}

void LoopRecorder::onState(const fmbpc::PlantState::ConstPtr& msg) {
  guarded(topics::kPlantState,
          [&] { collect<PlantState>(fromMsg(*msg), &SampleRecord::has_state, &Recorder::add); });
}

void LoopRecorder::onTracking(const fmbpc::Tracking::ConstPtr& msg) {
  guarded(topics::kTracking,
          [&] { collect<Tracking>(fromMsg(*msg), &SampleRecord::has_tracking, &Recorder::add); });
}

void LoopRecorder::onBase(const fmbpc::ControlAction::ConstPtr& msg) {
  guarded(topics::kBaseAction, [&] {
    collect<ControlAction>(fromMsg(*msg), &SampleRecord::has_base, &Recorder::addBase);
  });
}

void LoopRecorder::onAction(const fmbpc::ControlAction::ConstPtr& msg) {
  guarded(topics::kControlAction, [&] {
    collect<ControlAction>(fromMsg(*msg), &SampleRecord::has_action, &Recorder::addAction);
  });
}

void LoopRecorder::onReport(const fmbpc::SolverReport::ConstPtr& msg) {
  guarded(topics::kSolverReport,
          [&] { collect<SolverReport>(fromMsg(*msg), &SampleRecord::has_report, &Recorder::add); });
}

void LoopRecorder::checkComplete() {
  if (!recorder_.complete()) return;
  final_seen_ = {};
  write();
  if (!keep_) done();
}

void LoopRecorder::write() {
  const double wall_s = (ros::SteadyTime::now() - began_).toSec();
  const RunRecord record = recorder_.take();
  const Summary summary = summarize(loop_, record, wall_s);
  written_ = true;
  ROS_INFO("loop_recorder: %u samples in %.3f s", summary.steps, wall_s);
  if (!out_.empty()) {
    writeRun(loop_, record, summary, out_);
    const PlotResult plot = plot_ ? drawPlot(out_) : PlotResult{};
    if (!plot.warning.empty()) ROS_WARN("loop_recorder: %s", plot.warning.c_str());
    ROS_INFO("loop_recorder: written: %s", out_.c_str());
  }
  std_msgs::String folder;
  folder.data = out_;
  if (ros::ok()) recorded_.publish(folder);
  if (record.failed_samples == 0) return;
  const std::string words = troubleOf(summary);
  if (!keep_) return fail(words);
  ROS_ERROR("loop_recorder: %s", words.c_str());
}

int LoopRecorder::finish() {
  const int code = Node::finish();
  if (code != 0 || written_) return code;
  if (loop_.simulation.samples == 0 && run_known_) {
    write();
    return 0;
  }
  ROS_ERROR("loop_recorder: stopped before the final sample: nothing is written");
  return 1;
}

void LoopRecorder::report(Diagnostics::Status& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (!plant_.problem().empty())
    status.summary(DiagnosticStatus::ERROR, plant_.problem());
  else if (!ready_.announced())
    status.summary(DiagnosticStatus::WARN, "waiting for publishers of the ring");
  else
    status.summary(DiagnosticStatus::OK, written_     ? "written"
                                         : run_known_ ? "recording"
                                                      : "waiting");
  status.add("step", measured_.step);
  status.add("waiting for their measurement", early_.size());
  status.add("dropped: other run", strays_);
  status.add("dropped: wrong size or not finite", wrong_size_);
  addRefused(status, refused());
  addRefused(status, setpoints_.refused());
}

}  // namespace fpc
