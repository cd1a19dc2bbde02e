// Controller type swarm_mpc: its section of a loop file.
#include "control/mpc/read_horizon.hpp"
#include "control/mpc/swarm_mpc.hpp"

namespace fpc {
namespace {

SwarmParams readSwarm(YamlSection& controller) {
  SwarmParams params = SwarmMpcParams{}.swarm;
  YamlSection section = controller.section("swarm");
  section.integer("particles", params.particles, 1, 100000);
  section.integer("iterations", params.iterations, 0, 100000);
  section.finish();
  return params;
}

SwarmMpcParams readSwarmMpc(YamlSection& section, const ControllerContext& loop) {
  SwarmMpcParams params;
  params.horizon = readHorizon(section, loop);
  params.swarm = readSwarm(section);
  checked(section, [&] { params.validate(loop.outputCount(), loop.inputCount()); });
  return params;
}

std::unique_ptr<Controller> makeSwarmMpc(const SwarmMpcParams& params,
                                         const ControllerContext& loop) {
  return std::make_unique<SwarmMpc>(params, loop.limits, loop.plant);
}

ControllerType describeSwarmMpc() {
  ControllerType type{"swarm_mpc", "predictive control by a particle swarm on a fuzzy model"};
  type.needs_model = true;
  return type;
}

const bool kSwarmMpcRegistered =
    registerController<SwarmMpcParams>({describeSwarmMpc(), &readSwarmMpc, &makeSwarmMpc});

}  // namespace
}  // namespace fpc
