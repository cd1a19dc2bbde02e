// Listens to the whole exchange and writes the files that `fmbpc run --out` writes.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/PlantState.h>
#include <fmbpc/Recorded.h>
#include <fmbpc/SolverReport.h>
#include <fmbpc/Tracking.h>
#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "ros/bag_writer.hpp"
#include "ros/health_reporter.hpp"
#include "ros/listener_gate.hpp"
#include "ros/node.hpp"
#include "ros/plant_gate.hpp"
#include "ros/ready.hpp"
#include "ros/run_end.hpp"
#include "runtime/record_store.hpp"
#include "runtime/recorder_clock.hpp"
#include "runtime/recorder_session.hpp"

namespace fpc {

/// Ready when every publisher of the exchange is connected. Says of each sample that it has all of
/// it: a simulated plant goes on only then. What it records is on disk at once (see RecordStore)
/// and becomes the run's files at its end, at Ctrl-C, and in the next run if the process was
/// killed; one that comes back goes on with the same record. With a folder that it cannot use it is
/// failed, says why on run_end, and is never ready. Ends with the run: exit code 0 when it is
/// complete and written (then `recorded`, latched, names the folder); otherwise 1, naming the gaps.
/// Parameters: ~out, folder of the files (nothing is written without it); ~bag, file for all
/// topics; ~keep, the launch goes on after the run (run_end is not said); ~stay, this node goes on
/// until it is stopped, as in a launch, which ends by run_end; ~plot, draw plot.png (default true).
class LoopRecorder : public Node {
 public:
  static std::string idleReason(const LoopFile&) { return ""; }
  LoopRecorder(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);
  int finish() override;

 private:
  template <typename Msg>
  using Handler = void (LoopRecorder::*)(const Msg& msg, const std::string& publisher);
  template <typename Msg>
  void listen(ros::NodeHandle& node, const char* topic, Handler<Msg> handler);
  void onPlantInfo(const fmbpc::PlantInfo& msg, const std::string& publisher);
  void onMeasurement(const fmbpc::Measurement& msg, const std::string& publisher);
  void onState(const fmbpc::PlantState& msg, const std::string& publisher);
  void onTracking(const fmbpc::Tracking& msg, const std::string& publisher);
  void onBase(const fmbpc::ControlAction& msg, const std::string& publisher);
  void onAction(const fmbpc::ControlAction& msg, const std::string& publisher);
  void onReport(const fmbpc::SolverReport& msg, const std::string& publisher);

  std::unique_ptr<RecordStore> openStore(const std::string& folder);
  void poll();
  void giveUp();
  void watchGaps();
  bool isConnected();
  void beginRun(std::uint64_t run_id);
  template <typename Msg, typename Take>
  void record(const char* topic, const Msg& msg, Take take);
  void acknowledge(const StepHeader& sample);
  void conclude();
  bool tryWrite();
  int writeRest();
  void end();
  void sayEnd();
  Health health(double now_s) const;
  void report(Diagnostics::Status& status) const;

  LoopFile loop_;
  bool keep_, plot_, stay_;
  std::string unusable_;       // why the folder is
  double started_s_;           // this process
  bool run_under_way_{false};  // heard of, while the folder is unusable
  std::unique_ptr<RecordStore> store_;
  RecorderSession session_;
  ReadyPublisher ready_;
  PlantGate plant_;
  std::string announcer_;  // of the run: its measurements count
  std::unique_ptr<BagWriter> bag_;
  double looked_s_{-1};           // at the topics
  int polls_{};                   // since the last look at gaps
  std::uint32_t told_{}, due_{};  // gaps before it are said; will be at the next look
  double lacks_s_{-1};            // since when the newest samples lack something ...
  std::string lacks_;             // ... in words
  bool bag_ready_{false};

  RecorderClock clock_;
  double ending_s_{-1};
  bool written_{false}, said_end_{false};
  std::string problem_, trouble_;  // of the recorder; of the plant
  double connected_s_{-1};         // since when every publisher is there

  ros::Publisher recorded_, sample_recorded_;
  RunEndPublisher end_;
  std::vector<ros::Subscriber> ring_;  // every topic that must have a publisher
  ListenerGate publishers_{{}};        // all that the master knows of them
  SteadyTimer poll_timer_;
  HealthReporter health_;
};

}  // namespace fpc
