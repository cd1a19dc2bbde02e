#include "runtime/commissioning/brief.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/yaml_section.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;

constexpr double kFewestSamples = 60;

std::string textOf(const std::string& file) {
  std::ifstream stream(file);
  require(static_cast<bool>(stream), file, "a brief: a readable file");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// {NAME: [low, high]} over what is there.
void readRanges(YamlSection& brief, const std::string& key, const std::vector<SignalInfo>& signals,
                Vector& lower, Vector& upper) {
  YamlSection section = brief.section(key);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    section.markRead(signals[i].name);
    if (!section.has(signals[i].name)) continue;
    std::vector<double> range;
    section.numbers(signals[i].name, range);
    if (range.size() != 2 || !(range[0] < range[1]))
      section.fail(signals[i].name, "[low, high] with low < high");
    lower[static_cast<Index>(i)] = range[0];
    upper[static_cast<Index>(i)] = range[1];
  }
  section.finish();
}

void readValues(YamlSection& brief, const std::string& key, const std::vector<SignalInfo>& signals,
                Vector& values, Range range) {
  YamlSection section = brief.section(key);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    section.markRead(signals[i].name);
    if (section.has(signals[i].name))
      section.number(signals[i].name, values[static_cast<Index>(i)], range);
  }
  section.finish();
}

std::string loopBeside(const std::string& brief, const std::string& loop) {
  const fs::path beside = fs::path(brief).parent_path() / loop;
  std::error_code error;
  return fs::is_regular_file(beside, error) ? beside.string() : loop;
}

void requireAll(const YamlSection& section, const std::string& key,
                const std::vector<SignalInfo>& signals, const Vector& values,
                const std::string& expected) {
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (!std::isfinite(values[static_cast<Index>(i)]))
      section.fail(key + "." + signals[i].name, expected + " [" + signals[i].unit + "]");
}

}  // namespace

std::vector<bool> CommissioningBrief::counted() const {
  std::vector<bool> counted = held;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (std::isfinite(zone_lower[at]) || std::isfinite(zone_upper[at])) counted[i] = true;
  }
  return counted;
}

std::uint32_t CommissioningBrief::samples() const {
  return static_cast<std::uint32_t>(plant_time_h * 3600.0 / loop.plant_info.sample_time_s);
}

CommissioningBrief readBrief(const std::string& file, const LoopFile* running) {
  CommissioningBrief b;
  b.file = fs::absolute(file).lexically_normal().string();
  b.text = textOf(file);
  YamlSection section = YamlSection::parse(b.text, file);
  std::string loop;
  if (running == nullptr) need(section, "loop", "the plant's loop file, by name or path");
  section.text("loop", loop);
  if (running == nullptr) {
    b.loop = readLoop(loopBeside(file, loop));
  } else {
    if (!loop.empty() && fs::path(loop).stem() != running->name)
      section.fail("loop", "the loop that runs, " + running->name + ", or nothing; got " + loop);
    b.loop = *running;
  }
  const auto& y = b.loop.plant_info.outputs;
  const auto& u = b.loop.plant_info.inputs;
  const Index n_y = countOf(y);
  const auto limit = [&](const std::vector<double>& known, double none) {
    return known.empty() ? Vector(Vector::Constant(n_y, none))
                         : Vector(Eigen::Map<const Vector>(known.data(), n_y));
  };
  b.lower = limit(b.loop.report.output_lower, -kInfinity);
  b.upper = limit(b.loop.report.output_upper, kInfinity);
  readRanges(section, "limits", y, b.lower, b.upper);
  for (Index i = 0; i < n_y; ++i) {  // of what has none: what the plant can show
    const SignalInfo& about = y[static_cast<std::size_t>(i)];
    if (!std::isfinite(b.lower[i])) b.lower[i] = about.lower;
    if (!std::isfinite(b.upper[i])) b.upper[i] = about.upper;
  }
  requireAll(section, "limits", y, b.lower, "the lowest value that no test may leave");
  requireAll(section, "limits", y, b.upper, "the highest value that no test may leave");
  b.zone_lower = Vector::Constant(n_y, -kInfinity);
  b.zone_upper = Vector::Constant(n_y, kInfinity);
  readRanges(section, "zone", y, b.zone_lower, b.zone_upper);
  b.move = b.loop.simulation.actuator.limits.move;
  readValues(section, "moves", u, b.move, kFinitePositive);
  requireAll(section, "moves", u, b.move, "the largest move per sample");
  const InputLimits& inputs = b.loop.simulation.actuator.limits;  // a move beyond a range is none
  b.move = b.move.cwiseMin(inputs.move).cwiseMin(inputs.upper - inputs.lower);
  b.hold = b.loop.setpoint.initial;
  Vector asked = Vector::Constant(n_y, kNaN);
  readValues(section, "hold", y, asked, kFinite);
  for (Index i = 0; i < n_y; ++i) {
    if (!std::isfinite(asked[i])) continue;
    b.hold[i] = asked[i];
    b.hold_asked.push_back(y[static_cast<std::size_t>(i)].name);
    b.hold_values.push_back(asked[i]);
  }
  b.closed = !b.loop.controllerType().open_loop;
  for (Index i = 0; i < n_y; ++i) {
    const std::string& name = y[static_cast<std::size_t>(i)].name;
    if (!(b.hold[i] > b.lower[i] && b.hold[i] < b.upper[i]))
      section.fail("hold." + name, "a setpoint between the limits " + exactText(b.lower[i]) +
                                       " and " + exactText(b.upper[i]) + ", got " +
                                       exactText(b.hold[i]));
    const bool zone = std::isfinite(b.zone_lower[i]) || std::isfinite(b.zone_upper[i]);
    b.held.push_back(!zone && (b.hold_asked.empty() || std::isfinite(asked[i])));
  }
  if (std::none_of(b.held.begin(), b.held.end(), [](bool held) { return held; }))
    section.fail("zone", "an output that is to be held, without a zone");
  need(section, "plant_time_h", "the hours of plant time that watching and testing may use");
  section.number("plant_time_h", b.plant_time_h, Range::positive());
  if (b.samples() < kFewestSamples)
    section.fail("plant_time_h",
                 "at least 60 samples of " + exactText(b.loop.plant_info.sample_time_s) + " s");
  section.seed("seed", b.seed);
  section.finish();
  require(running != nullptr || !b.loop.external_plant, file + ": loop",
          "a simulated plant; one that runs over topics or behind a gateway is commissioned with "
          "--topics");
  return b;
}

}  // namespace fpc
