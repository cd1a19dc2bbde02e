// Section `controller` of types nmpc and swarm_mpc: the horizon and cost that both share, and how
// each of them searches.
#include "config/plant_sample_model.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

void readHorizon(YamlSection& section, HorizonParams& params, const LoopNames& names) {
  const auto n_y = static_cast<Index>(names.outputs.size());
  params.reference_pole = Vector::Zero(n_y);
  params.weight_output = Vector::Ones(n_y);
  params.weight_move = Vector::Zero(static_cast<Index>(names.inputs.size()));
  section.integer("horizon_steps", params.horizon_steps, 1, 10000);
  section.integer("move_steps", params.move_steps, 1, 1000);
  section.byName("reference_pole", params.reference_pole, names.outputs, {0.0, 1.0});
  section.boolean("preview", params.preview);
  section.byName("weight_output", params.weight_output, names.outputs, kFiniteNotNegative);
  section.byName("weight_move", params.weight_move, names.inputs, kFiniteNotNegative);
}

void readSwarm(YamlSection& controller, SwarmParams& params) {
  YamlSection section = controller.section("swarm");
  section.integer("particles", params.particles, 1, 100000);
  section.integer("iterations", params.iterations, 0, 100000);
  section.number("inertia_start", params.inertia_start, kFiniteNotNegative);
  section.number("inertia_end", params.inertia_end, kFiniteNotNegative);
  section.number("cognitive", params.cognitive, kFiniteNotNegative);
  section.number("social", params.social, kFiniteNotNegative);
  section.number("speed_upper", params.speed_upper, {0.0, 1.0, true});
  section.seed("seed", params.seed);
  section.finish();
}

}  // namespace

void readHorizonMpc(YamlSection& section, LoopFile& loop, const LoopNames& names) {
  const auto n_y = static_cast<Index>(names.outputs.size());
  const auto n_u = static_cast<Index>(names.inputs.size());
  if (loop.controller == "swarm_mpc") {
    SwarmMpcParams& params = loop.swarm_mpc;
    readHorizon(section, params.horizon, names);
    readSwarm(section, params.swarm);
    return checked(section, [&] { params.validate(n_y, n_u); });
  }
  NmpcParams& params = loop.nmpc;
  readHorizon(section, params.horizon, names);
  section.integer("max_iterations", params.solver.max_iterations, 1, 10000);
  section.integer("integration_steps", params.integration_steps, 1, 10000);
  if (loop.external_plant)
    section.fail("type", "a plant that can be simulated: nmpc predicts with the plant's equations");
  checked(section, [&] {
    params.validate(n_y, n_u);
    makePlantSampleModel(loop.simulation, params.integration_steps);
  });
}

}  // namespace fpc
