// Where the plant is to rest, decided anew at every sample from the model, what disturbs it and all
// limits.
#pragma once

#include <cstdint>
#include <memory>

#include "control/targets/params.hpp"
#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// How far targets have moved in a run.
struct TargetMoves {
  std::uint64_t moved{};  ///< samples at which some input's target moved by more than 1e-6 of its
                          ///< range
  double travel{};        ///< sum of all moves of inputs' targets, over their ranges
};

/// Per sample: a ModelObserver says what disturbs the outputs; the model at rest is linearised at
/// the last target (SteadyModel) and the best rest found (TargetSolver), again from there until
/// neither moves, at most `iterations` times. Ranks: integrating outputs in balance before all
/// others, then those of the section. Inputs without a resting value rest where their last target
/// was, so that a target within `band` of the least cost stays: there are no jumps between two that
/// cost the same. Where nothing can be found the last target stays, and an event says why.
/// No allocation in step().
class TargetLayer {
 public:
  /// @throws InputError naming the field.
  TargetLayer(TargetParams params, InputLimits limits, PlantInfo plant);
  ~TargetLayer();
  TargetLayer(TargetLayer&&) noexcept;
  /// Matched to the plant; acts from the next step(). @throws InputError if it does not fit.
  void setModel(const TsModel& model);
  bool ready() const;  ///< it has a model
  void reset();   ///< what comes next is no continuation: targets start from the inputs in force
  void forget();  ///< another run: moves count from 0
  /// `setpoint`: n_y, as asked. Values that are not finite: the last target stays.
  void step(const Measurement& now, VectorRef setpoint, Targets& targets);
  const Notices& events() const;  ///< of the last step
  const TargetMoves& moves() const;
  double seconds() const;  ///< wall time of the last step; never used in a decision

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace fpc
