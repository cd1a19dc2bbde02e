// Brings a model's signals into the order of the plant, so that everything behind it may index by
// PlantInfo.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/fuzzy/model_match.hpp"

namespace fpc {
namespace {

constexpr double kSameTime = 1e-3;  // of the sample time: records round and jitter

int indexOf(const std::vector<SignalInfo>& signals, const std::string& name) {
  const auto found =
      std::find_if(signals.begin(), signals.end(), [&](const auto& s) { return s.name == name; });
  return found == signals.end() ? -1 : static_cast<int>(found - signals.begin());
}

/// Where each of the model's signals is in the plant.
std::vector<int> places(const std::string& where, const std::vector<SignalInfo>& model,
                        const std::vector<SignalInfo>& plant) {
  std::vector<int> to;
  for (const auto& signal : model) {
    const int place = indexOf(plant, signal.name);
    require(
        place >= 0, where + "." + signal.name,
        "a signal of the plant, which has " + (plant.empty() ? "nothing" : join(namesOf(plant))));
    const std::string& unit = plant[static_cast<std::size_t>(place)].unit;
    require(signal.unit == unit, where + "." + signal.name,
            "the plant's unit '" + unit + "', got '" + signal.unit + "'");
    to.push_back(place);
  }
  return to;
}

/// The plant's names and units with the ranges of the model.
std::vector<SignalInfo> reordered(const std::vector<SignalInfo>& model,
                                  const std::vector<SignalInfo>& plant) {
  std::vector<SignalInfo> signals = plant;
  for (auto& signal : signals) {
    const int place = indexOf(model, signal.name);
    const double infinite = std::numeric_limits<double>::infinity();
    signal.lower = place < 0 ? -infinite : model[static_cast<std::size_t>(place)].lower;
    signal.upper = place < 0 ? infinite : model[static_cast<std::size_t>(place)].upper;
  }
  return signals;
}

/// The domain's rows in the order of the plant; a signal that the model has not does not count.
ModelDomain reordered(const ModelDomain& model, const std::vector<std::vector<int>>& places,
                      const PlantInfo& plant) {
  if (model.empty()) return {};
  const std::size_t sizes[] = {plant.outputs.size(), plant.inputs.size(),
                               plant.disturbances.size()};
  ModelDomain domain;
  domain.radius = model.radius;
  const auto n = static_cast<Eigen::Index>(sizes[0] + sizes[1] + sizes[2]);
  domain.centres = Matrix::Zero(n, model.centres.cols());
  domain.scale = Vector::Constant(n, std::numeric_limits<double>::infinity());
  Eigen::Index from = 0, first = 0;
  for (std::size_t kind = 0; kind < places.size(); ++kind) {
    for (const int place : places[kind]) {
      domain.centres.row(first + place) = model.centres.row(from);
      domain.scale[first + place] = model.scale[from++];
    }
    first += static_cast<Eigen::Index>(sizes[kind]);
  }
  return domain;
}

}  // namespace

TsModel matchToPlant(const TsModel& model, const PlantInfo& plant) {
  model.validate();
  const std::string where = "model '" + model.name + "'";
  require(
      std::abs(model.sample_time_s - plant.sample_time_s) <= kSameTime * plant.sample_time_s,
      where + " sample_time_s",
      "the plant's " + exactText(plant.sample_time_s) + ", got " + exactText(model.sample_time_s));
  const std::vector<int> outputs = places(where + " outputs", model.outputs, plant.outputs);
  const std::vector<int> inputs = places(where + " inputs", model.inputs, plant.inputs);
  const std::vector<int> disturbances =
      places(where + " disturbances", model.disturbances, plant.disturbances);
  for (const auto& output : plant.outputs)
    require(indexOf(model.outputs, output.name) >= 0, where + " outputs",
            "also the plant's output " + output.name);

  TsModel matched = model;
  matched.sample_time_s = plant.sample_time_s;
  matched.outputs = reordered(model.outputs, plant.outputs);
  matched.inputs = reordered(model.inputs, plant.inputs);
  matched.disturbances = reordered(model.disturbances, plant.disturbances);
  matched.domain = reordered(model.domain, {outputs, inputs, disturbances}, plant);
  for (std::size_t i = 0; i < outputs.size(); ++i)
    matched.submodels[static_cast<std::size_t>(outputs[i])] = model.submodels[i];
  for (auto& submodel : matched.submodels)
    for (auto* list : {&submodel.antecedents, &submodel.regressors})
      for (auto& regressor : *list) {
        const auto& to = regressor.kind == SignalKind::kOutput  ? outputs
                         : regressor.kind == SignalKind::kInput ? inputs
                                                                : disturbances;
        regressor.index = to[static_cast<std::size_t>(regressor.index)];
      }
  return matched;
}

}  // namespace fpc
