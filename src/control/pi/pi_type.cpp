// Controller type pi: its section of a loop file.
#include "control/pi/read_pi.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace {

PiLoop readLoop(YamlSection& item, const ControllerContext& loop) {
  PiLoop pi;
  pi.input = indexByName(item, "input", loop.inputs());
  pi.output = indexByName(item, "output", loop.outputs());
  need(item, "kp", "a number");
  item.number("kp", pi.kp, kFinite);
  item.number("ki_per_h", pi.ki_per_h, kFinite);
  pi.bias = loop.initial_input[pi.input];
  item.number("bias", pi.bias, kFinite);
  item.boolean("reverse", pi.reverse);
  readOption(item, "anti_windup", pi.anti_windup);
  item.number("tracking_time_h", pi.tracking_time_h, kFinitePositive);
  if (item.has("tracking_time_h") && pi.anti_windup != AntiWindup::kTracking)
    item.fail("tracking_time_h", "anti_windup: tracking beside it");
  readOption(item, "start", pi.start);
  pi.gain_schedule = readCurve(item, "gain_schedule", "factor");
  readPiTerms(item, pi.terms, loop);
  item.finish();
  return pi;
}

PiParams readPi(YamlSection& section, const ControllerContext& loop) {
  PiParams params;
  if (section.has("reference_pole")) {
    params.reference_pole = Vector::Constant(loop.outputCount(), 0.9);
    section.byName("reference_pole", params.reference_pole, loop.outputs(), {0.0, 1.0});
  }
  need(section, "loops", "a list of loops");
  for (auto& item : section.list("loops")) params.loops.push_back(readLoop(item, loop));
  checked(section, [&] {
    params.validate(loop.outputCount(), loop.inputCount(),
                    static_cast<Eigen::Index>(loop.disturbances().size()));
  });
  return params;
}

std::unique_ptr<Controller> makePi(const PiParams& params, const ControllerContext& loop) {
  return std::make_unique<PiController>(params, loop.limits, loop.plant);
}

/// What its loops take and move.
SignalUse usedByPi(const PiParams& params, const ControllerContext& loop) {
  SignalUse use = noSignal(loop);
  const std::size_t n_y = loop.plant.outputs.size();
  const auto need_at = [&](std::size_t index) { use.needed[index] = true; };
  std::vector<int> moved;
  for (const PiLoop& control : params.loops) {
    need_at(static_cast<std::size_t>(control.output));
    use.followed.push_back(control.output);
    moved.push_back(control.input);
    for (const PiFeedforward& term : control.terms.feedforward)
      for (const int index : {term.disturbance, term.times})
        if (index >= 0) need_at(n_y + static_cast<std::size_t>(index));
  }
  use.moved = theseInputs(loop, moved);
  return use;
}

ControllerType describePi() {
  ControllerType type{"pi", "PI control, one loop per input, gains scheduled if asked"};
  type.settings = piSettings().infos();
  return type;
}

const bool kPiRegistered =
    registerController<PiParams>({describePi(), &readPi, &makePi, nullptr, &usedByPi});

}  // namespace
}  // namespace fpc
