#include "tool/reproduce/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace fpc::tool {
namespace {

constexpr double kExact = 0.01;
const double kNothing = std::numeric_limits<double>::quiet_NaN();

std::vector<Experiment>& registry() {
  static std::vector<Experiment> all;
  return all;
}

}  // namespace

const char* name(Verdict verdict) {
  static const char* const names[] = {"reproduced", "close", "not_reproducible", "better"};
  return names[static_cast<int>(verdict)];
}

bool registerExperiment(Experiment experiment) {
  registry().push_back(std::move(experiment));
  return true;
}

std::vector<Experiment> experiments() {
  std::vector<Experiment> all = registry();
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

ReproduceRow compare(const std::string& quantity, double paper, double here,
                     const std::string& unit, double close, const std::string& reason) {
  const double off = paper == 0.0 ? std::abs(here) : std::abs(here - paper) / std::abs(paper);
  char within[80];
  std::snprintf(within, sizeof within, "within %.2g %%", 100.0 * off);
  if (off <= kExact) return {quantity, paper, here, unit, Verdict::kReproduced, within};
  if (off > close) std::snprintf(within, sizeof within, "off by %.3g %%", 100.0 * off);
  const std::string note = reason.empty() ? within : std::string(within) + "; " + reason;
  return {quantity, paper, here, unit, off <= close ? Verdict::kClose : Verdict::kNotReproducible,
          note};
}

ReproduceRow state(const std::string& quantity, double here, const std::string& unit,
                   Verdict verdict, const std::string& note) {
  return {quantity, kNothing, here, unit, verdict, note};
}

ReproduceRow outOfReach(const std::string& quantity, double paper, const std::string& unit,
                        const std::string& reason) {
  return {quantity, paper, kNothing, unit, Verdict::kNotReproducible, reason};
}

}  // namespace fpc::tool
