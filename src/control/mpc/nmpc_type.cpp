// Controller type nmpc: its section of a loop file.
#include "control/mpc/nmpc.hpp"
#include "control/mpc/read_horizon.hpp"

namespace fpc {
namespace {

NmpcParams readNmpc(YamlSection& section, const ControllerContext& loop) {
  NmpcParams params;
  params.horizon = readHorizon(section, loop);
  if (!loop.plant_model)
    section.fail("type", "a plant that can be simulated: nmpc predicts with the plant's equations");
  checked(section, [&] {
    params.validate(loop.outputCount(), loop.inputCount());
    loop.plant_model();
  });
  return params;
}

std::unique_ptr<Controller> makeNmpc(const NmpcParams& params, const ControllerContext& loop) {
  return std::make_unique<Nmpc>(params, loop.limits, loop.plant, loop.plant_model());
}

const bool kNmpcRegistered = registerController<NmpcParams>(
    {{"nmpc",
      "nonlinear predictive control on the plant's own equations: a baseline told the truth"},
     &readNmpc,
     &makeNmpc});

}  // namespace
}  // namespace fpc
