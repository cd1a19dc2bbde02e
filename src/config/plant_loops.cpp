#include "config/plant_loops.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "base/yaml_node.hpp"
#include "config/read_scenarios.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {

namespace {

namespace fs = std::filesystem;

/// That a text can hold.
double finite(double limit) { return std::clamp(limit, -kLargest, kLargest); }

constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

std::vector<std::string> wordsOf(LoopLink::To) {
  return {"disturbance", "input", "setpoint", "forecast", "pace"};
}

std::vector<std::string> wordsOf(LoopLink::Of) { return {"outputs", "inputs", "plan"}; }

bool isNameOfLoop(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

/// A loop by its name in config/loop, or by a path from where the plant file lies.
std::string loopBeside(const std::string& loop, const std::string& file) {
  const fs::path beside = fs::path(file).parent_path() / loop;
  return fs::path(loop).extension() == ".yaml" && fs::is_regular_file(beside) ? beside.string()
                                                                              : loop;
}

PlantLoop readOne(YamlSection& item, const std::string& name, const Overrides& common) {
  PlantLoop one;
  one.name = name;
  std::string loop;
  need(item, "loop", "name of a loop (fmbpc loops lists them), or a path");
  item.text("loop", loop);
  item.boolean("isolate", one.isolate);
  item.text("machine", one.machine);
  Overrides set = common;
  for (auto& own : readSet(item)) set.push_back(std::move(own));
  item.finish();
  try {
    one.loop = parseLoop(resolveLoop(loopBeside(loop, item.file()), set), name);
  } catch (const InputError& error) {
    throw InputError(item.where("loop") + ": " + error.what());
  }
  return one;
}

std::vector<PlantLoop> readAllLoops(YamlSection& root, const Overrides& common) {
  YamlSection section = root.section("loops");
  std::vector<PlantLoop> loops;
  for (const std::string& name : section.keys()) {
    if (!isNameOfLoop(name)) section.fail(name, "a name of letters, digits and _: a namespace");
    YamlSection item = section.section(name);
    loops.push_back(readOne(item, name, common));
  }
  if (loops.empty()) root.fail("loops", "at least one NAME: {loop: LOOP}");
  return loops;
}

/// Of "LOOP/SIGNAL".
struct SignalOfLoop {
  PlantLoop* of;
  std::string signal;
};

SignalOfLoop readSignal(YamlSection& item, const std::string& key, std::vector<PlantLoop>& loops) {
  need(item, key, "LOOP/SIGNAL");
  std::string text;
  item.text(key, text);
  const auto slash = text.find('/');
  std::vector<std::string> names;
  for (PlantLoop& loop : loops) {
    names.push_back(loop.name);
    if (slash != std::string::npos && text.substr(0, slash) == loop.name)
      return {&loop, text.substr(slash + 1)};
  }
  item.fail(key, "LOOP/SIGNAL with a loop out of " + join(names) + "; got '" + text + "'");
}

const SignalInfo& signalOf(YamlSection& item, const std::string& key, const SignalOfLoop& what,
                           const std::vector<SignalInfo>& among, const std::string& kind,
                           Eigen::Index& index) {
  const auto found = std::find_if(among.begin(), among.end(),
                                  [&](const SignalInfo& one) { return one.name == what.signal; });
  if (found == among.end())
    item.fail(key, kind + " of " + what.of->name + ": " +
                       (among.empty() ? "it has none" : join(namesOf(among))) + "; got '" +
                       what.signal + "'");
  index = found - among.begin();
  return *found;
}

LoopLink linkFrom(const PlantLoop& other, LoopLink::Of of, Eigen::Index index) {
  const SimulationParams& from = other.loop.simulation;
  const SampleClock clock(from.sample_time_s, from.start_time_s);
  LoopLink link;
  link.from = other.name;
  link.of = of;
  link.index = index;
  link.every_ns = link.reach_ns = clock.timeAt(1) - clock.timeAt(0);
  link.first_ns = clock.timeAt(0);
  const std::uint32_t unanswered = of == LoopLink::Of::kOutputs ? 0 : 1;  // the final one
  link.last_ns = from.samples == 0 ? kNoEnd : clock.timeAt(from.samples - unanswered);
  return link;
}

/// A source stays near who listens to it, so that nothing overflows on the way.
void keepPace(PlantLoop& source, const PlantLoop& listener) {
  constexpr std::int64_t kAhead = 1000;  // samples
  for (const LoopLink& link : source.links)
    if (link.to == LoopLink::To::kPace && link.from == listener.name) return;
  LoopLink link = linkFrom(listener, LoopLink::Of::kOutputs, 0);
  const LoopLink own = linkFrom(source, LoopLink::Of::kOutputs, 0);
  link.to = LoopLink::To::kPace;
  link.name = "pace";
  link.reach_ns = kAhead * std::max(link.every_ns, own.every_ns);
  source.links.push_back(std::move(link));
}

/// @throws InputError if something else stands for the signal already.
void add(YamlSection& item, const std::string& key, PlantLoop& from, PlantLoop& to, LoopLink link) {
  keepPace(from, to);
  for (const LoopLink& other : to.links)
    if (other.to == link.to && other.name == link.name)
      item.fail(key, "a signal that has one source; " + to.name + "/" + link.name +
                         " has another one, of " + other.from);
  to.links.push_back(std::move(link));
}

/// The plan of the other law is what this one expects of the disturbance from the next sample on.
void readPlan(YamlSection& item, const SignalOfLoop& from, const SignalOfLoop& to, LoopLink link) {
  const LoopFile &sender = from.of->loop, &receiver = to.of->loop;
  const auto& measured = receiver.plant_info.disturbances;
  if (link.of != LoopLink::Of::kInputs)
    item.fail("plan", "`from` with an input of " + from.of->name + ": its outputs are not planned");
  if (link.every_ns != linkFrom(*to.of, LoopLink::Of::kInputs, 0).every_ns)
    item.fail("plan", "loops with one sample time");
  if (!sender.controllerType().predicts)
    item.fail("plan", "a loop that plans; controller " + sender.controllerType().name + " of " +
                          from.of->name + " does not");
  if (sender.has_clp)
    item.fail("plan", "a sender without clp: what an optimizer changes is not in the law's plan");
  if (!receiver.controller->signalUse(controllerContext(receiver)).looks_ahead)
    item.fail("plan",
              "a receiver whose law looks ahead at disturbances (type fmbpc, law: iterated); " +
                  to.of->name + " has none");
  if (std::none_of(measured.begin(), measured.end(),
                   [&](const SignalInfo& one) { return one.name == link.name; }))
    item.fail("plan", "a measured disturbance of " + to.of->name + "; got '" + link.name + "'");
  link.of = LoopLink::Of::kPlan;
  link.to = LoopLink::To::kForecast;
  add(item, "to", *from.of, *to.of, std::move(link));
}

/// A signal of one loop as a disturbance of another.
void readFeed(YamlSection& item, std::vector<PlantLoop>& loops) {
  const SignalOfLoop from = readSignal(item, "from", loops), to = readSignal(item, "to", loops);
  Eigen::Index index = 0, ignored = 0;
  const PlantInfo& source = from.of->loop.plant_info;
  const bool input = std::any_of(source.inputs.begin(), source.inputs.end(),
                                 [&](const SignalInfo& one) { return one.name == from.signal; });
  signalOf(item, "from", from, input ? source.inputs : source.outputs, "an output or input", index);
  if (to.of->loop.external_plant)
    item.fail("to", "a loop with a simulated plant; what disturbs a real one is among its tags");
  if (from.of == to.of) item.fail("to", "another loop than that of `from`");
  std::vector<SignalInfo> disturbances;
  const std::unique_ptr<Plant> plant = makePlant(to.of->loop.simulation);
  for (const Quantity& q : plant->description().disturbances)
    disturbances.push_back({q.name, q.unit, q.lower, q.upper});
  const SignalInfo& target = signalOf(item, "to", to, disturbances, "a disturbance", ignored);
  LoopLink link = linkFrom(*from.of, input ? LoopLink::Of::kInputs : LoopLink::Of::kOutputs, index);
  link.name = target.name;
  link.lower = finite(target.lower);
  link.upper = finite(target.upper);
  item.number("gain", link.gain, kFinite);
  item.number("offset", link.offset, kFinite);
  bool plan = false;
  item.boolean("plan", plan);
  double until_h = kLargest;
  item.number("plan_until_h", until_h, kFiniteNotNegative);
  if (!plan && item.has("plan_until_h")) item.fail("plan_until_h", "plan: true beside it");
  item.finish();
  add(item, "to", *from.of, *to.of, link);
  if (!plan) return;
  const double samples = std::floor(until_h * 3600e9 / static_cast<double>(link.every_ns));
  if (samples < static_cast<double>((link.last_ns - link.first_ns) / link.every_ns))
    link.last_ns = link.first_ns + static_cast<std::int64_t>(samples) * link.every_ns;
  readPlan(item, from, to, link);
}

/// What the outer loop asks for is the inner one's setpoint; what its plant gets is the inner
/// loop's output, which its law sees as the applied input.
void readCascade(YamlSection& item, std::vector<PlantLoop>& loops) {
  const SignalOfLoop outer = readSignal(item, "outer", loops),
                     inner = readSignal(item, "inner", loops);
  if (outer.of == inner.of) item.fail("inner", "another loop than that of `outer`");
  if (inner.of->loop.targets.enabled)
    item.fail("inner", "a loop without a section targets, which decides on setpoints itself");
  Eigen::Index input = 0, output = 0;
  const SignalInfo& asked =
      signalOf(item, "outer", outer, outer.of->loop.plant_info.inputs, "an input", input);
  const SignalInfo& followed =
      signalOf(item, "inner", inner, inner.of->loop.plant_info.outputs, "an output", output);
  item.finish();
  if (!std::isfinite(outer.of->loop.simulation.actuator.limits.move[input]))
    item.fail("outer",
              "an input with a move limit (actuator.move_upper): the outer law may ask for so "
              "much beyond where the inner loop is, and winds up no further");
  const Vector &lowest = inner.of->loop.setpoint.lower, &highest = inner.of->loop.setpoint.upper;
  const double lower =
      lowest.size() > 0 ? std::max(lowest[output], followed.lower) : followed.lower;
  const double upper =
      highest.size() > 0 ? std::min(highest[output], followed.upper) : followed.upper;
  if (asked.lower < lower || asked.upper > upper)
    item.fail("outer", "an input whose limits, " + rangeText(asked.lower, asked.upper, asked.unit) +
                           ", lie inside those of the setpoint of " + inner.of->name + "/" +
                           followed.name + ", " + rangeText(lower, upper, followed.unit) +
                           ": set.actuator or set.setpoint");
  LoopLink ask = linkFrom(*outer.of, LoopLink::Of::kInputs, input);
  ask.to = LoopLink::To::kSetpoint;
  ask.name = followed.name;
  ask.lower = finite(lower);
  ask.upper = finite(upper);
  add(item, "inner", *outer.of, *inner.of, ask);
  if (outer.of->loop.external_plant) return;  // its gateway reads where the input is
  LoopLink back = linkFrom(*inner.of, LoopLink::Of::kOutputs, output);
  back.to = LoopLink::To::kInput;
  back.name = asked.name;
  back.lower = finite(asked.lower);
  back.upper = finite(asked.upper);
  add(item, "outer", *inner.of, *outer.of, back);
}

}  // namespace

const PlantLoop& PlantLoops::of(const std::string& loop) const {
  std::vector<std::string> names;
  for (const PlantLoop& one : loops) {
    if (one.name == loop) return one;
    names.push_back(one.name);
  }
  throw InputError("loop '" + loop + "': expected one of " + join(names) + " of " + file);
}

PlantLoops readPlantLoops(const std::string& name_or_path, const Overrides& set) {
  PlantLoops plant;
  plant.file = findPlantLoops(name_or_path);
  plant.name = fs::path(plant.file).stem().string();
  YamlSection root = YamlSection::load(plant.file);
  root.text("title", plant.title);
  std::string pace = "realtime";
  double speedup = 1.0;
  root.oneOf("pace", pace, wordsOf(Pace{}));
  root.number("speedup", speedup, kFinitePositive);
  Overrides common{{"loop.pace", pace}, {"loop.speedup", exactText(speedup)}};
  for (auto& own : readSet(root)) common.push_back(std::move(own));
  common.insert(common.end(), set.begin(), set.end());
  plant.loops = readAllLoops(root, common);
  for (YamlSection& item : root.list("links")) readFeed(item, plant.loops);
  for (YamlSection& item : root.list("cascades")) readCascade(item, plant.loops);
  root.finish();
  return plant;
}

std::string textOf(const std::vector<LoopLink>& links) {
  YAML::Emitter text;
  text << YAML::BeginMap << YAML::Key << "links" << YAML::Value << YAML::BeginSeq;
  for (const LoopLink& link : links)
    text << YAML::Flow << YAML::BeginMap << YAML::Key << "from" << YAML::Value << link.from
         << YAML::Key << "of" << YAML::Value << wordsOf(link.of)[static_cast<std::size_t>(link.of)]
         << YAML::Key << "index" << YAML::Value << link.index << YAML::Key << "every_ns"
         << YAML::Value << link.every_ns << YAML::Key << "reach_ns" << YAML::Value << link.reach_ns
         << YAML::Key << "first_ns" << YAML::Value << link.first_ns << YAML::Key << "last_ns"
         << YAML::Value << link.last_ns << YAML::Key << "to" << YAML::Value
         << wordsOf(link.to)[static_cast<std::size_t>(link.to)] << YAML::Key << "name"
         << YAML::Value << link.name << YAML::Key << "gain" << YAML::Value << exactText(link.gain)
         << YAML::Key << "offset" << YAML::Value << exactText(link.offset) << YAML::Key << "lower"
         << YAML::Value << exactText(link.lower) << YAML::Key << "upper" << YAML::Value
         << exactText(link.upper) << YAML::EndMap;
  text << YAML::EndSeq << YAML::EndMap;
  return text.c_str();
}

std::vector<LoopLink> parseLinks(const std::string& text, const std::string& name) {
  YamlSection root = YamlSection::parse(text, name);
  std::vector<LoopLink> links;
  for (YamlSection& item : root.list("links")) {
    LoopLink link;
    std::string to = "disturbance", of = "outputs", every, reach, first, last;
    int index = 0;
    item.text("from", link.from);
    item.integer("index", index, 0);
    item.text("every_ns", every);
    item.text("reach_ns", reach);
    item.text("first_ns", first);
    item.text("last_ns", last);
    const std::vector<std::string> words = wordsOf(link.to), sources = wordsOf(link.of);
    item.oneOf("to", to, words);
    item.oneOf("of", of, sources);
    item.text("name", link.name);
    item.number("gain", link.gain, kFinite);
    item.number("offset", link.offset, kFinite);
    item.number("lower", link.lower);
    item.number("upper", link.upper);
    item.finish();
    link.index = index;
    link.every_ns = std::stoll(every);
    link.reach_ns = std::stoll(reach);
    link.first_ns = std::stoll(first);
    link.last_ns = std::stoll(last);
    link.of =
        static_cast<LoopLink::Of>(std::find(sources.begin(), sources.end(), of) - sources.begin());
    link.to = static_cast<LoopLink::To>(std::find(words.begin(), words.end(), to) - words.begin());
    links.push_back(std::move(link));
  }
  root.finish();
  return links;
}

}  // namespace fpc
