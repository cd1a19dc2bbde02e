#include "study/seeded_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/random.hpp"
#include "config/extending_loop.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

/// The number at a key of a resolved loop, or the plant's own where the loop does not say.
double ownNumber(const LoopFile& loop, const std::string& key) {
  const std::string text = scalarOf(loop.resolved, key);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::isfinite(value)) return value;
  const std::string expected = "a key that has a number in loop " + loop.name;
  require(text.empty() && !loop.external_plant, "vary." + key, expected);
  const PlantDescription about = makePlant(loop.simulation)->description();
  using Section = std::pair<std::string, const std::vector<Quantity>&>;
  for (const auto& [section, quantities] :
       {Section{"plant.parameters", about.parameters}, Section{"plant.initial_state", about.states},
        Section{"disturbance.nominal", about.disturbances}})
    for (const Quantity& quantity : quantities)
      if (key == section + "." + quantity.name) return quantity.nominal;
  throw InputError("vary." + key + ": expected " + expected);
}

}  // namespace

std::vector<std::string> seededKeys(const LoopFile& loop, bool noisy) {
  std::vector<std::string> keys;
  const auto& sensors = loop.simulation.instruments.sensors;
  if (noisy || loop.disturbance.source == DisturbanceSource::kPattern ||
      std::any_of(sensors.begin(), sensors.end(), [](const auto& sensor) {
        return sensor.second.noise_std > 0.0 || sensor.second.lost > 0.0;
      }))
    keys.emplace_back("seed");
  const auto& parameters = loop.simulation.parameters;
  const auto local = parameters.find("local_noise");
  if (local != parameters.end() && local->second > 0.0)
    keys.emplace_back("plant.parameters.local_noise_seed");
  return keys;
}

std::vector<double> drawnBy(std::uint64_t seed, const std::vector<Variation>& vary) {
  std::vector<double> drawn;
  for (std::size_t v = 0; v < vary.size(); ++v) {
    std::mt19937_64 engine = seededEngine(seed, {0x5354554459U, v});
    drawn.push_back(vary[v].lower + (vary[v].upper - vary[v].lower) * uniform(engine));
  }
  return drawn;
}

double unitOf(const Variation& variation, const LoopFile& loop) {
  if (!variation.factor) return 1.0;
  const double number = ownNumber(loop, variation.key);
  require(
      number != 0.0, "vary." + variation.key,
      "values (value:LOWER:UPPER) in place of factors: the number of loop " + loop.name + " is 0");
  return number;
}

}  // namespace fpc
