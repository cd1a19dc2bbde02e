// Keys of a loop of controller.type pi besides its gains: see PiTerms.
#include <algorithm>

#include "control/pi/read_pi.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

PiScheduleSignal readScheduleSignal(YamlSection& item, const ControllerContext& context) {
  using Kind = PiScheduleSignal::Kind;
  PiScheduleSignal signal;
  std::vector<std::string> choices;
  std::vector<PiScheduleSignal> meant;
  const auto add = [&](const std::vector<std::string>& known, Kind kind,
                       const std::string& prefix) {
    for (std::size_t i = 0; i < known.size(); ++i) {
      choices.push_back(prefix + known[i]);
      meant.push_back({kind, static_cast<int>(i)});
    }
  };
  add(context.outputs(), Kind::kOutput, "");
  add(context.outputs(), Kind::kSetpoint, "setpoint/");
  add(context.disturbances(), Kind::kDisturbance, "");
  add(context.inputs(), Kind::kInput, "");
  std::string name;
  item.text("schedule_by", name);
  if (name.empty()) return signal;
  item.oneOf("schedule_by", name, choices);
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i] == name) return meant[i];
  return signal;
}

std::vector<PiFeedforward> readFeedforward(YamlSection& loop, const ControllerContext& context) {
  std::vector<PiFeedforward> all;
  for (auto& item : loop.list("feedforward")) {
    PiFeedforward one;
    one.disturbance = indexByName(item, "disturbance", context.disturbances());
    need(item, "gain", "a number");
    item.number("gain", one.gain, kFinite);
    one.nominal = context.disturbance_nominal[one.disturbance];
    item.number("nominal", one.nominal, kFinite);
    item.number("lead_h", one.lead_h, kFiniteNotNegative);
    item.number("lag_h", one.lag_h, kFiniteNotNegative);
    item.finish();
    all.push_back(one);
  }
  return all;
}

}  // namespace

void readPiTerms(YamlSection& loop, PiTerms& terms, const ControllerContext& context) {
  loop.number("kd_h", terms.kd_h, kFinite);
  loop.number("derivative_lag_h", terms.derivative_lag_h, kFiniteNotNegative);
  loop.number("preview_h", terms.preview_h, kFiniteNotNegative);
  loop.number("setpoint_pole", terms.setpoint_pole, {0.0, 1.0});
  loop.number("setpoint_lead_h", terms.setpoint_lead_h, kFiniteNotNegative);
  for (auto& item : loop.list("static_input")) {
    CurvePoint point;
    for (const char* key : {"output", "input"}) need(item, key, "a number");
    item.number("output", point.at, kFinite);
    item.number("input", point.value, kFinite);
    item.finish();
    terms.static_input.push_back(point);
  }
  terms.feedforward = readFeedforward(loop, context);
  terms.schedule = readScheduleSignal(loop, context);
}

}  // namespace fpc
