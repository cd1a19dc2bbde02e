// One loop of a plant in a process of many: all its nodes in one thread of its own, with a queue of
// its own, so that none waits for another loop and a message within the loop wakes nobody.
#pragma once

#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "config/plant_loops.hpp"

namespace fpc {

/// What the launch says of all loops.
struct HostOptions {
  std::string out;  ///< folder of the records, one below it for each loop; empty: none
  bool keep{};      ///< stays after the runs
  bool draw{};      ///< plot.png of each
};

/// Parameters of the loop's nodes on the master, below `space`: for those in this process and in
/// another one.
void setLoopParameters(const std::string& space, const PlantLoop& loop, const HostOptions& options);

/// What is thrown in a loop's nodes, and a node that fails, ends this loop and no other. A crash
/// ends the process, and code that never returns holds its thread for ever.
class HostedLoop {
 public:
  /// `space`: the loop's namespace, in full.
  explicit HostedLoop(std::string space);
  ~HostedLoop();
  HostedLoop(const HostedLoop&) = delete;
  HostedLoop& operator=(const HostedLoop&) = delete;

  /// Tells the thread to end; the nodes say their last word.
  void tellToEnd() { told_ = true; }
  /// False: it has not ended within this time.
  bool waitForEnd(double seconds);
  bool ended() const {
    return ended_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  /// Why it ended though nobody told it to; empty otherwise.
  std::string failure() const;
  /// The nodes are all there.
  bool made() const { return made_; }

 private:
  void live();
  void turnNodes();
  void fail(const std::string& why);

  const std::string space_;
  std::atomic<bool> told_{false}, made_{false};
  mutable std::mutex mutex_;  // of failure_
  std::string failure_;
  std::promise<void> end_;
  std::future<void> ended_;
  std::thread thread_;
};

}  // namespace fpc
