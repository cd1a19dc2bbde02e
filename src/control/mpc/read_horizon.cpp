#include "control/mpc/read_horizon.hpp"

#include "control/read_observer.hpp"

namespace fpc {

HorizonParams readHorizon(YamlSection& section, const ControllerContext& loop) {
  HorizonParams params;
  params.reference_pole = Vector::Zero(loop.outputCount());
  params.weight_output = Vector::Ones(loop.outputCount());
  params.weight_move = Vector::Zero(loop.inputCount());
  section.integer("horizon_steps", params.horizon_steps, 1, 10000);
  section.integer("move_steps", params.move_steps, 1, 1000);
  section.byName("reference_pole", params.reference_pole, loop.outputs(), {0.0, 1.0});
  section.boolean("preview", params.preview);
  section.integer("reference_lead_steps", params.reference_lead_steps, 0, 100000);
  params.observe = readObserver(section, params.observer, loop, ObserverKey::kInputStd);
  section.byName("weight_output", params.weight_output, loop.outputs(), kFiniteNotNegative);
  section.byName("weight_move", params.weight_move, loop.inputs(), kFiniteNotNegative);
  return params;
}

}  // namespace fpc
