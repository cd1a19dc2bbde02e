// What every controller is: a law with memory that turns a measurement and a setpoint into an input
// inside its limits.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/control/setpoint_source.hpp"
#include "fmbpc/control/settings.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Filled by step(); sized by the controller at its first step, reused afterwards (no allocation
/// per sample). The session calls begin() before each step(), so a law fills in `input`, and the
/// rest only where it differs.
struct ControllerOutput {
  void begin() {
    source = ActionSource::kBase;
    predictive = false;
    ok = true;
    events.clear();
  }
  Vector input;  ///< n_u, inside bounds and move limit
  ActionSource source{ActionSource::kHeld};
  Vector reference;        ///< n_y, y_r(k)
  bool predictive{false};  ///< `prediction` is valid
  PredictiveAction prediction;
  bool ok{true};   ///< false: nothing finite came out, ...; `events` say why
  Notices events;  ///< what is to be known of this sample, also when ok
};

class Controller {
 public:
  virtual ~Controller() = default;
  /// Starts from a finite measurement, bumplessly: the next step() moves on from input_applied.
  virtual void reset(const Measurement& start) = 0;
  /// What it has learned of the process in this run is of no use: the next reset() starts as the
  /// first one. Without allocation. Default: nothing.
  virtual void forget() {}
  /// u(k). `now` is finite and of the right sizes, `setpoint` already advanced to this step. What
  /// was really sent instead of the last proposal (manual, optimizer) is in now.input_applied.
  /// Works in fixed time without allocation; limits hold whatever happens inside.
  virtual void step(const Measurement& now, const SetpointSource& setpoint,
                    ControllerOutput& output) = 0;
  /// A sample at which somebody else has the inputs (a person, a hold): the law asks for nothing,
  /// but may keep following the process, so that reset() at the very next sample finds its hidden
  /// states where they are. Finite; without allocation. Default: nothing.
  virtual void lookOn(const Measurement& now);
  /// What it expects to be measured at this sample, whose outputs are not to be read; false if it
  /// expects nothing. Only between two samples that it gets one after the other. Without
  /// allocation.
  virtual bool foresee(const Measurement& now, Eigen::Ref<Vector> outputs);
  /// What a measured disturbance is expected to be: element i at sample k+i, NaN where nothing is
  /// known; after the last element as there. Counts for the step() of sample k only. False: the law
  /// has no use for it. Without allocation. Default: false.
  virtual bool expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead);
  virtual bool needsModel() const { return false; }
  /// False for an open-loop experiment: setpoints and references are then recorded as NaN.
  virtual bool followsSetpoint() const { return true; }
  /// Takes a new model between two samples, bumplessly. A law without a model ignores it.
  /// @throws InputError if it does not fit; the old one stays.
  virtual void setModel(const TsModel& model);
  /// Whether an input that does not come from step() (a person's) may be sent. Default: any.
  virtual bool mayBeSent(VectorRef input) const;
  /// Moves an input that does not come from step() (held, manual) to the nearest one that may be
  /// sent. Default: nothing.
  virtual void makeSendable(Eigen::Ref<Vector> input) const;
  /// Whether the controller may change itself from now on. Returns false if it never does.
  virtual bool adapt(bool on);
  /// What may be changed while it runs, as it is now. Default: nothing.
  virtual Settings settings() const;
  /// Takes these from the next sample on, without a bump; others stay. Returns false if there is
  /// nothing to change. @throws InputError and takes nothing then.
  virtual bool retune(const Settings& settings);
  /// Signals for plotting, "NAME" -> value, refreshed by step(). Default: none.
  virtual const std::vector<std::pair<std::string, double>>& signals() const;
};

}  // namespace fpc
