// Listens to the whole ring and writes the files that `fmbpc run --out` writes; keeps the
// operator's setpoints.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/PlantState.h>
#include <fmbpc/SolverReport.h>
#include <fmbpc/Tracking.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"
#include "fmbpc/ros/diagnostics.hpp"
#include "fmbpc/ros/node.hpp"
#include "fmbpc/ros/plant_gate.hpp"
#include "fmbpc/ros/ready.hpp"
#include "fmbpc/ros/setpoint_latch.hpp"

namespace fpc {

/// Ready when every publisher of the ring is connected. Ends with the run: exit code 0 when it is
/// complete and written (then `recorded`, latched, names the folder); otherwise 1, naming the gaps,
/// and no summary.json is left. An endless run is written at Ctrl-C. Parameters: ~out, folder of
/// the files (nothing is written without it); ~keep, do not end with the run; ~plot, draw plot.png
/// (default true).
class LoopRecorder : public Node {
 public:
  static std::string idleReason(const LoopFile&) { return ""; }
  /// @throws InputError
  LoopRecorder(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);
  int finish() override;

 private:
  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onMeasurement(const fmbpc::Measurement::ConstPtr& msg);
  void onState(const fmbpc::PlantState::ConstPtr& msg);
  void onTracking(const fmbpc::Tracking::ConstPtr& msg);
  void onBase(const fmbpc::ControlAction::ConstPtr& msg);
  void onAction(const fmbpc::ControlAction::ConstPtr& msg);
  void onReport(const fmbpc::SolverReport::ConstPtr& msg);

  void beginRun(const StepHeader& header);
  /// Takes one item per sample and kind; what is ahead of the measurements waits for them.
  template <typename Item>
  void collect(const Item& item, bool SampleRecord::*has, void (Recorder::*add)(const Item&));
  void deliverEarly();
  bool fits(const Measurement& m) const;
  bool fits(const PlantState& s) const;
  bool fits(const Tracking& t) const;
  bool fits(const ControlAction& a) const;
  bool fits(const SolverReport& r) const;
  void poll();
  void announceIfConnected();
  void checkComplete();
  void write();
  void removeOldFiles() const;
  void report(Diagnostics::Status& status) const;

  LoopFile loop_;
  std::string out_;
  bool keep_, plot_;
  Recorder recorder_;
  SetpointLatch setpoints_;
  ReadyPublisher ready_;
  PlantGate plant_;
  Eigen::Index n_y_, n_u_, n_d_;

  StepHeader measured_;  // the latest sample of the run being recorded
  bool run_known_{false};
  struct Early {
    StepHeader header;
    std::function<void()> deliver;
  };
  std::vector<Early> early_;
  std::vector<fmbpc::Measurement::ConstPtr>
      unannounced_;  // of runs that plant_info has not announced yet
  std::uint64_t strays_{}, wrong_size_{};
  ros::SteadyTime began_, final_seen_;
  bool written_{false};
  int polls_connected_{};

  ros::Publisher recorded_;
  std::vector<ros::Subscriber> ring_;  // every publisher that must be connected
  ros::WallTimer poll_timer_;
  Diagnostics diagnostics_;
};

}  // namespace fpc
