// The members of a loop, called in the order in which messages would travel: what runLoop() and
// runPlant() turn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "config/plant_loops.hpp"
#include "runtime/command_player.hpp"
#include "runtime/link_inbox.hpp"
#include "runtime/loop_controller.hpp"
#include "runtime/plant_session.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/run.hpp"

namespace fpc {

class LoopExchange {
 public:
  /// Keeps references to both. @throws InputError for an external plant, an endless run, or without
  /// the model a law needs.
  LoopExchange(const LoopFile& loop, const RunOptions& options,
               const std::vector<LoopLink>& links = {});

  /// The sample on the table: its answer, then the next one. False: it was the final one.
  bool step() {
    answer();
    return advance();
  }
  /// The two halves of step(), for loops with links: each when everything that it needs of other
  /// loops has come.
  bool mayAnswer() { return asks_.ready(measurement().header.time_ns); }
  void answer();
  bool mayAdvance() { return feeds_.ready(measurement().header.time_ns); }
  bool advance();
  /// What another loop sends.
  void hear(const std::string& from, LoopLink::Of of, const StepHeader& sample,
            const Eigen::Ref<const Matrix>& values, bool planned = true);

  const ControlAction& sent() const { return controller_.sent(); }
  const ControllerAnswer& answered() const { return controller_.answer(); }
  const Measurement& measurement() const { return simulation_.measurement(); }
  const LoopFile& loop() const { return loop_; }
  const RunRecord& recorded() const { return record_; }  ///< what is complete of it so far
  RunRecord take();

 private:
  void takeFromOthers(const Measurement& now);

  const LoopFile& loop_;
  const RunOptions& options_;
  std::unique_ptr<SimulatedProcess> made_;  // until it is the session's
  Simulation& simulation_;
  PlantSession plant_;
  LoopController controller_;
  CommandPlayer player_;
  RunRecord record_;
  RecorderSession recorder_;
  CommandTargets targets_;
  LinkInbox feeds_, asks_;  // of the plant; of the controller
};

}  // namespace fpc
