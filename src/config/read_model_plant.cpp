// Plant type `model`: plant.model is a model file, plant.ranges where its signals can be.
#include "config/design_library.hpp"
#include "config/identified_file.hpp"
#include "config/range.hpp"
#include "config/read.hpp"

namespace fpc {
namespace {

constexpr double kHalfWidth = 1.959963984540054;  // 95 % of a normal distribution, in deviations

std::vector<SignalInfo> readRanges(YamlSection& plant, const TsModel& model) {
  YamlSection section = plant.section("ranges");
  std::vector<SignalInfo> ranges;
  for (const auto* group : {&model.outputs, &model.inputs, &model.disturbances})
    for (const SignalInfo& signal : *group) {
      SignalInfo range = signal;
      if (readRange(section, signal.name, range.lower, range.upper, kFinite))
        ranges.push_back(std::move(range));
    }
  section.finish();
  return ranges;
}

IdentifiedModel readFound(YamlSection& plant) {
  std::string file;
  need(plant, "model", "a model file");
  plant.text("model", file);
  try {
    return designLibrary(plant.where("type")).read_identified(file);
  } catch (const InputError& e) {
    throw InputError(plant.where("model") + ": " + e.what());
  }
}

PlantFactory readModelPlant(YamlSection& plant) {
  const IdentifiedModel found = readFound(plant);
  return [model = found.model, errors = modelErrorsOf(found),
          ranges = readRanges(plant, found.model)](const PlantParameters& none) {
    auto made = std::make_unique<ModelPlant>(model, errors, ranges);
    parameterValues(made->description(), none);  // has none: refuses every name
    return made;
  };
}

const bool kModelPlantRegistered = registerPlantReader(
    "model", "An identified model with its noise: plant.model", &readModelPlant);

}  // namespace

ModelErrors modelErrorsOf(const IdentifiedModel& found) {
  ModelErrors errors;
  const auto n = static_cast<Eigen::Index>(found.outputs.size());
  errors.one_step = errors.free_run = Vector::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const IdentifiedOutput& o = found.outputs[static_cast<std::size_t>(i)];
    errors.one_step[i] = o.one_step_width / kHalfWidth;
    errors.free_run[i] = o.free_run_width / kHalfWidth;
  }
  return errors;
}

}  // namespace fpc
