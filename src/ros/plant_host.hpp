// The node plant_host: the loops of a plant file, in its own process or in one each, with one state
// for all; each is started, stopped and replaced without the others.
#pragma once

#include <fmbpc/LoopOrder.h>
#include <fmbpc/LoopState.h>
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <sys/types.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/plant_loops.hpp"
#include "ros/health_reporter.hpp"
#include "ros/hosted_loop.hpp"
#include "ros/run_end.hpp"
#include "ros/steady_timer.hpp"
#include "runtime/health.hpp"

namespace fpc {

/// Parameters: ~plant, name or path of the plant file; ~set, keys over all its loops; ~machine,
/// whose loops run here; ~only, one loop, in this process whatever the file says (that is what an
/// isolated loop's process is told); ~out, folder of the records; ~keep, stays after the runs;
/// ~draw, plot.png of each loop. Service ~order (LoopOrder). loop_state is that of the plant, from
/// the summaries of all loops, those of other machines included; run_end when every run of this
/// machine is recorded.
class PlantHost {
 public:
  /// @throws InputError
  PlantHost(ros::NodeHandle node, ros::NodeHandle private_node);
  ~PlantHost();
  /// Tells all loops of this machine to end, while they still can say so.
  void sayLast();
  /// Waits for them. The exit code: 1 if one of them failed.
  int finish();

 private:
  /// One loop of the file, wherever it runs.
  struct Place {
    PlantLoop loop;
    bool ours{}, stopped{};
    std::unique_ptr<HostedLoop> here;
    pid_t process{};      // of an isolated one; 0: none
    std::string end;      // what its run_end said last
    std::string trouble;  // why it does not live though nobody stopped it

    ros::Subscriber state, run_end;
  };

  bool onOrder(fmbpc::LoopOrder::Request& request, fmbpc::LoopOrder::Response& response);
  void order(std::uint8_t order, const std::string& loop);
  void add(const PlantLoop& loop);
  void onState(Place& place, const fmbpc::LoopState& msg);
  void start(Place& place);
  void stop(Place& place);
  void startProcess(Place& place);
  std::string spaceOf(const PlantLoop& loop) const;
  void look();
  void lookAt(Place& place);
  Health health(double now_s) const;
  void sayEndWhenDue();

  ros::NodeHandle node_, private_node_;
  std::string file_, machine_, only_;
  Overrides set_;
  HostOptions options_;
  std::map<std::string, Place> places_;  // by name of the loop
  std::map<std::string, Health> healths_;
  std::map<std::string, double> heard_s_;
  double begun_s_;
  bool ended_{false}, failed_{false};
  RunEndPublisher end_;
  ros::ServiceServer order_;
  std::unique_ptr<HealthReporter> health_;  // none of a process for one loop
  SteadyTimer timer_;
};

int runPlantHost(int argc, char** argv);

}  // namespace fpc
