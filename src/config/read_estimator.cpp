// Section `estimator`: outputs that nobody measures.

#include <algorithm>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kBadlyKnown = 0.1;  // of the initial value of what is not measured

}  // namespace

void readEstimator(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("estimator");
  EstimatorParams& params = loop.estimator;
  const std::vector<std::string> all = namesOf(loop.plant_info.outputs);
  const Index n_y = countOf(loop.plant_info.outputs);
  std::vector<std::string> hidden;
  section.subset("outputs", hidden, all);
  for (const auto& name : hidden)
    params.outputs.push_back(std::find(all.begin(), all.end(), name) - all.begin());
  params.initial = params.process_std = params.noise_std = Vector::Zero(n_y);
  section.byName("initial", params.initial, all, kFinite);
  params.initial_std = kBadlyKnown * params.initial.cwiseAbs();
  if (loop.simulation.noise_std.size() == n_y) params.noise_std = loop.simulation.noise_std;
  section.byName("noise_std", params.noise_std, all, kFiniteNotNegative);
  section.byName("process_std", params.process_std, all, kFinitePositive);
  if (!hidden.empty()) {
    if (!loop.controllerType().needs_model)
      section.fail("outputs", "nothing, or a controller.type that predicts with a fuzzy model");
    if (!loop.controller->signalUse(controllerContext(loop)).estimated.empty())
      section.fail("outputs",
                   "nothing beside controller.observer.estimated: the estimator would take what "
                   "nobody measures to be 0");
    checked(section, [&] { params.validate(n_y); });
  }
  section.finish();
}

}  // namespace fpc
