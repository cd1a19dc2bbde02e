// What answers a plant: controller, target layer, optimizer and identifier of a loop, called in the
// order in which messages would travel. The run in one process is made of it, and a controller that
// is stepped by somebody else's program.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/base/event.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/session.hpp"
#include "runtime/target_session.hpp"

namespace fpc {

struct LoopControllerHooks {
  /// A model that was identified between two samples; may be empty.
  std::function<void(const TsModel& model)> identified;
  /// A model that could not be had or used, or what an operator asked in vain, said at once; may be
  /// empty.
  std::function<void(const Event& event)> said;
};

/// Sample k is answered and learned from; a model made from it is used from sample k + 1 on, as
/// over topics in lockstep.
class LoopController {
 public:
  /// Keeps a reference to `loop`. @throws InputError without the model that a law needs, or if it
  /// does not fit.
  explicit LoopController(const LoopFile& loop, LoopControllerHooks hooks = {});

  /// Answers a sample, see ControllerSession::receive(); then optimize() and learn() with it.
  Receipt receive(const Measurement& now);
  const ControllerAnswer& answer() const { return session_.answer(); }
  /// u(k) as it goes to the plant: the optimizer's where there is one.
  const ControlAction& optimize();
  const ControlAction& sent() const { return optimizer_ ? optimizer_->action() : answer().base; }
  const SolverReport& report() const { return optimizer_->report(); }
  bool hasOptimizer() const { return optimizer_.has_value(); }
  /// What the sample gives the identifier, after it has been answered.
  void learn(const Measurement& now);
  /// An identification that an operator asks for, of the newest rows (0: all).
  /// @throws InputError in a loop without model.identify.
  void identify(int window);
  /// The sample that is answered next, or was just now: of what is said meanwhile.
  void turnTo(std::uint32_t step) { step_ = step; }
  void say(EventCode code, const std::string& text);
  /// What was said since the last call, of the present sample: from it on it is in force.
  std::vector<Event> takeEvents();

  ControllerSession& session() { return session_; }
  const ControllerSession& session() const { return session_; }
  TargetSession* layer() { return layer_.get(); }  ///< null without a section targets

 private:
  bool needsModel() const { return layer_ || session_.controller().needsModel(); }
  void hand(const TsModel& model);
  void begin(const TsModel* model);
  void run(const IdentificationJob& job);
  void use(const TsModel* model);

  const LoopFile& loop_;
  LoopControllerHooks hooks_;
  ControllerSession session_;
  std::unique_ptr<TargetSession> layer_;
  std::optional<OptimizerSession> optimizer_;
  std::optional<IdentifierSession> identifier_;
  std::vector<Event> pending_;
  std::uint32_t step_{};
};

}  // namespace fpc
