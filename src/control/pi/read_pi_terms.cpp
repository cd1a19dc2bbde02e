// Keys of a loop of controller.type pi besides its gains: see PiTerms.
#include "control/pi/read_pi.hpp"

namespace fpc {
namespace {

std::vector<PiFeedforward> readFeedforward(YamlSection& loop, const ControllerContext& context) {
  std::vector<PiFeedforward> all;
  for (auto& item : loop.list("feedforward")) {
    PiFeedforward one;
    one.disturbance = indexByName(item, "disturbance", context.disturbances());
    if (item.has("times")) one.times = indexByName(item, "times", context.disturbances());
    need(item, "gain", "a number");
    item.number("gain", one.gain, kFinite);
    one.nominal = one.valueOf(context.disturbance_nominal);
    item.number("lag_h", one.lag_h, kFiniteNotNegative);
    item.finish();
    all.push_back(one);
  }
  return all;
}

}  // namespace

std::vector<CurvePoint> readCurve(YamlSection& loop, const std::string& key,
                                  const std::string& value_name) {
  std::vector<CurvePoint> curve;
  for (const auto& [at, value] : loop.pairs(key, "a list [[output, " + value_name + "], ...]"))
    curve.push_back({at, value});
  return curve;
}

void readPiTerms(YamlSection& loop, PiTerms& terms, const ControllerContext& context) {
  loop.number("kd_h", terms.kd_h, kFinite);
  loop.number("derivative_lag_h", terms.derivative_lag_h, kFiniteNotNegative);
  loop.number("preview_h", terms.preview_h, kFiniteNotNegative);
  loop.number("setpoint_pole", terms.setpoint_pole, {0.0, 1.0});
  loop.number("setpoint_lead_h", terms.setpoint_lead_h, kFiniteNotNegative);
  terms.static_input = readCurve(loop, "static_input", "input");
  terms.feedforward = readFeedforward(loop, context);
}

}  // namespace fpc
