// Sections `loop`, `tf` and `report`: how the exchange over topics runs, where equipment stands,
// what is judged.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::vector<std::string> exchangeNodes(const LoopFile& loop) {
  std::vector<std::string> nodes{"loop_recorder", "fmbpc_controller"};
  if (loop.controllerType().needs_model || loop.has_identify || loop.targets.enabled)
    nodes.emplace_back("fuzzy_identifier");
  if (loop.targets.enabled) nodes.emplace_back("target_optimizer");
  if (loop.has_clp) nodes.emplace_back("clp_optimizer");
  return nodes;
}

/// Who speaks on which topic; a plant that is not ours may have any name, unless it is behind our
/// gateway.
std::map<std::string, std::vector<std::string>> exchangePublishers(const LoopFile& loop) {
  using Names = std::vector<std::string>;
  const std::string controller = exchangeNodes(loop)[1];
  const Names plant = loop.gateway.enabled() ? Names{"plant_gateway"}
                      : loop.external_plant  ? Names{}
                                             : Names{"plant_simulator"};
  const Names law{controller};
  const Names answers = loop.has_clp ? Names{"clp_optimizer", controller} : law;
  const Names model{"fuzzy_identifier"};
  return {{"plant_info", plant},
          {"measurement", plant},
          {"plant_state", plant},
          {"base_action", law},
          {"tracking", law},
          {"predictive_action", law},
          {"control_action", answers},
          {"solver_report", answers},
          {"targets", {"target_optimizer"}},
          {"fuzzy_model", model},
          {"identified", model},
          {"setpoint", {}},
          {"disturbance", {}},
          {"sample_recorded", {"loop_recorder"}},
          {"operator_kept", plant},
          {"model_kept", plant},
          {"enable", {}},
          {"tags", {}},
          {"services", {}}};
}

void readPublishers(YamlSection& section, ExchangeParams& exchange) {
  YamlSection publishers = section.section("publishers");
  for (auto& [topic, names] : exchange.publishers) publishers.names(topic, names);
  publishers.finish();
}

/// Setpoints on Float64 topics go on to the controller in the gateway's name, which has asked
/// whether their publishers may set them.
void letGatewayForward(const GatewayParams& gateway, std::vector<std::string>& setpoint) {
  if (gateway.type == GatewayType::kFloat64 && !setpoint.empty())
    setpoint.emplace_back("plant_gateway");
}

void readFrame(YamlSection& item, EquipmentFrame& frame) {
  item.text("parent", frame.parent);
  Vector position(3);
  position << frame.x, frame.y, frame.z;
  item.vector("position", position, 3, kFinite);
  frame.x = position[0];
  frame.y = position[1];
  frame.z = position[2];
  item.finish();
}

void readFrames(YamlSection& section, std::vector<EquipmentFrame>& frames) {
  YamlSection items = section.section("frames");
  for (const auto& name : items.keys()) {
    YamlSection item = items.section(name);
    auto known =
        std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.name == name; });
    if (known == frames.end()) {
      need(item, "parent", "the parent frame of a new frame");
      frames.push_back({name, "", 0.0, 0.0, 0.0});
      known = frames.end() - 1;
    }
    readFrame(item, *known);
  }
}

/// Position in the root of the tree [m]; frames have no rotation.
Eigen::Vector3d positionOf(const std::string& name, const std::vector<EquipmentFrame>& frames,
                           const YamlSection& section) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::string at = name;
  for (std::size_t depth = 0; depth <= frames.size(); ++depth) {
    const auto frame =
        std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.name == at; });
    if (frame == frames.end()) return position;
    position += Eigen::Vector3d(frame->x, frame->y, frame->z);
    at = frame->parent;
  }
  throw InputError(section.where("frames") + "." + name + ": expected parents without a cycle");
}

std::vector<std::string> frameNames(const std::vector<EquipmentFrame>& frames) {
  std::vector<std::string> names;
  for (const auto& frame : frames) names.push_back(frame.name);
  return names;
}

void readLine(YamlSection& item, const YamlSection& tf, LoopFile& loop, const LoopNames& names) {
  SampleLine line;
  const auto frames = frameNames(loop.tf.frames);
  const auto output = static_cast<std::size_t>(indexByName(item, "output", names.outputs));
  line.output = names.outputs[output];
  line.from = frames[static_cast<std::size_t>(indexByName(item, "from", frames))];
  line.to = frames[static_cast<std::size_t>(indexByName(item, "to", frames))];
  need(item, "velocity_m_s", "a velocity > 0");
  item.number("velocity_m_s", line.velocity_m_s, kFinitePositive);
  item.finish();
  const double length_m =
      (positionOf(line.to, loop.tf.frames, tf) - positionOf(line.from, loop.tf.frames, tf)).norm();
  loop.simulation.output_delay_s[output] = length_m / line.velocity_m_s;
  loop.tf.sample_lines.push_back(std::move(line));
}

/// Keys of summary.json; what is consumed stands beside them.
const std::set<std::string> kSummaryKeys{
    "loop",   "title",  "run_id",     "first_step",     "complete", "steps",   "wall_s", "outputs",
    "inputs", "limits", "violations", "actuator_clips", "clp",      "sources", "events"};

ReportWindow readWindow(YamlSection& item, const std::vector<std::string>& outputs) {
  ReportWindow window;
  need(item, "name", "a name");
  item.text("name", window.name);
  item.text("output", window.output);
  if (item.has("output") && std::count(outputs.begin(), outputs.end(), window.output) == 0)
    item.fail("output", "one of " + join(outputs));
  double from_s = 0.0, to_s = 0.0;
  if (!item.interval("between_s", from_s, to_s, kFiniteNotNegative, "[from, to]"))
    item.fail("between_s", "[from, to]");
  window.from_h = from_s / 3600.0;
  window.to_h = to_s / 3600.0;
  item.finish();
  return window;
}

void readConsumption(YamlSection& report, const LoopNames& names,
                     std::vector<Consumption>& consumption) {
  YamlSection section = report.section("consumption");
  for (const auto& name : section.keys()) {
    if (kSummaryKeys.count(name) > 0) section.fail(name, "a name that the summary does not use");
    Consumption entry{name, Vector::Zero(static_cast<Eigen::Index>(names.inputs.size()))};
    section.byName(name, entry.rate, names.inputs, kFinite);
    consumption.push_back(std::move(entry));
  }
  section.finish();
}

/// A record that begins after the run has ended would hold nothing.
void requireInRun(const YamlSection& report, const LoopFile& loop) {
  const double end_h = loop.simulation.samples * loop.simulation.sample_time_s / 3600.0;
  if (loop.simulation.samples == 0 || loop.report.record_from_h <= end_h * (1.0 + 1e-9)) return;
  report.fail("record_from_h", "a time not after the end of the run, " + exactText(end_h) +
                                   " h (sampling.duration_h); 0 records all of a shortened run");
}

std::vector<double> toStd(const Vector& v) { return {v.data(), v.data() + v.size()}; }

}  // namespace

void readExchange(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("loop");
  readOption(section, "pace", loop.exchange.pace);
  section.number("speedup", loop.exchange.speedup, kFinitePositive);
  if (loop.gateway.enabled()) {  // a plant that is not ours waits for nobody
    loop.exchange.pace = Pace::kRealtime;
    loop.exchange.speedup = loop.gateway.speedup;
  }
  loop.exchange.wait_for = loop.exchange.members = exchangeNodes(loop);
  section.names("wait_for", loop.exchange.wait_for);
  section.number("ready_timeout_s", loop.exchange.ready_timeout_s, {0.0, 1e6, true});
  section.boolean("publish_clock", loop.exchange.publish_clock);
  section.number("action_timeout_s", loop.exchange.action_timeout_s, kFinitePositive);
  loop.exchange.publishers = exchangePublishers(loop);
  readPublishers(section, loop.exchange);
  letGatewayForward(loop.gateway, loop.exchange.publishers["setpoint"]);
  section.finish();
}

void readTf(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("tf");
  loop.tf.frames = names.plant.frames;
  if (loop.external_plant) loop.tf.frames = {{loop.plant_info.frame_id, "", 0.0, 0.0, 0.0}};
  loop.simulation.output_delay_s.assign(names.outputs.size(), 0.0);
  section.boolean("broadcast", loop.tf.broadcast);
  readFrames(section, loop.tf.frames);
  for (const auto& frame : loop.tf.frames) positionOf(frame.name, loop.tf.frames, section);
  for (auto& item : section.list("sample_lines")) readLine(item, section, loop, names);
  section.finish();
}

void readReport(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("report");
  const auto n_y = static_cast<Eigen::Index>(names.outputs.size());
  Vector lower = Vector::Constant(n_y, -kInfinity);
  Vector upper = Vector::Constant(n_y, kInfinity);
  section.byName("output_lower", lower, names.outputs);
  section.byName("output_upper", upper, names.outputs);
  if ((lower.array() > upper.array()).any()) section.fail("output_upper", "limits >= output_lower");
  for (auto& item : section.list("windows"))
    loop.report.windows.push_back(readWindow(item, names.outputs));
  section.number("record_from_h", loop.report.record_from_h, {0.0, 1e7});
  requireInRun(section, loop);
  readConsumption(section, names, loop.report.consumption);
  std::vector<std::string> free;
  section.subset("without_setpoint", free, names.outputs);
  for (const auto& name : free)
    loop.report.without_setpoint.push_back(
        std::find(names.outputs.begin(), names.outputs.end(), name) - names.outputs.begin());
  loop.report.output_lower = toStd(lower);
  loop.report.output_upper = toStd(upper);
  section.finish();
}

}  // namespace fpc
