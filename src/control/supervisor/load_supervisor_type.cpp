// Controller type load_supervisor: its section of a loop file.
#include "control/supervisor/load_supervisor.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

LoadSupervisorParams readSupervisor(YamlSection& section, const ControllerContext& loop) {
  LoadSupervisorParams params;
  params.input = indexByName(section, "input", loop.inputs());
  params.output = indexByName(section, "output", loop.outputs());
  for (const char* key : {"kp", "ki_per_h"}) need(section, key, "a number");
  section.number("kp", params.kp, kFinite);
  section.number("ki_per_h", params.ki_per_h, kFinite);
  if (params.ki_per_h != 0.0) params.tracking_time_h = params.kp / params.ki_per_h;
  section.number("tracking_time_h", params.tracking_time_h, kFinitePositive);
  section.number("integral_limit", params.integral_limit, kFiniteNotNegative);
  YamlSection load = section.section("load");
  params.concentration = indexByName(load, "concentration", loop.disturbances());
  params.flow = indexByName(load, "flow", loop.disturbances());
  params.nominal_load =
      loop.disturbance_nominal[params.concentration] * loop.disturbance_nominal[params.flow];
  load.number("gain", params.load_gain, kFinite);
  load.finish();
  checked(section, [&] { params.validate(); });
  return params;
}

std::unique_ptr<Controller> makeSupervisor(const LoadSupervisorParams& params,
                                           const ControllerContext& loop) {
  return std::make_unique<LoadSupervisor>(params, loop.limits, loop.plant);
}

SignalUse usedBySupervisor(const LoadSupervisorParams& params, const ControllerContext& loop) {
  SignalUse use = noSignal(loop);
  const auto n_y = static_cast<int>(loop.outputCount());
  for (const int index : {params.output, n_y + params.concentration, n_y + params.flow})
    use.needed[static_cast<std::size_t>(index)] = true;
  use.followed = {params.output};
  use.moved = theseInputs(loop, {params.input});
  return use;
}

ControllerType describeLoadSupervisor() {
  ControllerType type{"load_supervisor",
                      "PI control of one output with the measured load ahead of it"};
  type.settings = loadSupervisorSettings().infos();
  return type;
}

const bool kLoadSupervisorRegistered = registerController<LoadSupervisorParams>(
    {describeLoadSupervisor(), &readSupervisor, &makeSupervisor, nullptr, &usedBySupervisor});

}  // namespace
}  // namespace fpc
