// Brings a model's signals into the order of the plant, so that everything behind it may index by
// PlantInfo.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/model_match.hpp"

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
    require(signal.unit.empty() || signal.unit == unit, where + "." + signal.name,
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

/// Where a disturbance goes, in a model whose unmeasured ones count on behind them.
void renumber(TsModel& model, const std::vector<int>& to, std::size_t measured) {
  for (auto& submodel : model.submodels)
    for (auto* list : {&submodel.antecedents, &submodel.regressors})
      for (auto& r : *list) {
        if (r.kind != SignalKind::kDisturbance) continue;
        const int place = to[static_cast<std::size_t>(r.index)];
        const bool seen = place < static_cast<int>(measured);
        r.kind = seen ? SignalKind::kDisturbance : SignalKind::kUnmeasured;
        r.index = seen ? place : place - static_cast<int>(measured);
      }
}

/// The domain without these disturbances.
void dropRows(TsModel& model, const std::vector<bool>& dropped) {
  if (model.domain.empty()) return;
  ModelDomain& domain = model.domain;
  const auto first = static_cast<Eigen::Index>(model.outputs.size() + model.inputs.size());
  Eigen::Index rows = first;
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    if (dropped[i]) continue;
    const Eigen::Index from = first + static_cast<Eigen::Index>(i);
    domain.centres.row(rows) = domain.centres.row(from).eval();
    domain.scale[rows++] = domain.scale[from];
  }
  domain.centres.conservativeResize(rows, Eigen::NoChange);
  domain.scale.conservativeResize(rows);
}

/// Takes the disturbances that the plant does not measure and somebody estimates out of the others.
TsModel apart(const TsModel& model, const PlantInfo& plant,
              const std::vector<std::string>& estimated) {
  const auto isEstimated = [&](const SignalInfo& signal) {
    return indexOf(plant.disturbances, signal.name) < 0 &&
           std::find(estimated.begin(), estimated.end(), signal.name) != estimated.end();
  };
  if (std::none_of(model.disturbances.begin(), model.disturbances.end(), isEstimated)) return model;
  TsModel split = model;
  split.disturbances.clear();
  std::vector<bool> dropped;
  for (const SignalInfo& signal : model.disturbances) {
    dropped.push_back(isEstimated(signal));
    if (!dropped.back()) split.disturbances.push_back(signal);
  }
  for (const std::string& name : estimated) {  // in this order, whatever that of the model
    const int place = indexOf(model.disturbances, name);
    if (place >= 0 && dropped[static_cast<std::size_t>(place)])
      split.unmeasured.push_back(model.disturbances[static_cast<std::size_t>(place)]);
  }
  std::vector<int> to;
  int seen = 0;
  const auto measured = static_cast<int>(split.disturbances.size());
  for (std::size_t i = 0; i < dropped.size(); ++i)
    to.push_back(dropped[i] ? measured + indexOf(split.unmeasured, model.disturbances[i].name)
                            : seen++);
  renumber(split, to, split.disturbances.size());
  dropRows(split, dropped);
  return split;
}

}  // namespace

TsModel asIdentified(TsModel model) {
  const auto first = static_cast<int>(model.disturbances.size());
  for (auto& submodel : model.submodels)
    for (auto* list : {&submodel.antecedents, &submodel.regressors})
      for (auto& r : *list)
        if (r.kind == SignalKind::kUnmeasured)
          r = {SignalKind::kDisturbance, r.index + first, r.lag};
  ModelDomain& domain = model.domain;
  const Eigen::Index rows = domain.scale.size(),
                     more = static_cast<Eigen::Index>(model.unmeasured.size());
  if (!domain.empty() && more > 0) {
    domain.centres.conservativeResize(rows + more, Eigen::NoChange);
    domain.centres.bottomRows(more).setZero();
    domain.scale.conservativeResize(rows + more);
    domain.scale.tail(more).setConstant(std::numeric_limits<double>::infinity());
  }
  model.disturbances.insert(model.disturbances.end(), model.unmeasured.begin(),
                            model.unmeasured.end());
  model.unmeasured.clear();
  return model;
}

TsModel matchToPlant(const TsModel& given, const PlantInfo& plant,
                     const std::vector<std::string>& estimated) {
  given.validate();
  const TsModel model = apart(given, plant, estimated);
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
        if (regressor.kind == SignalKind::kUnmeasured) continue;
        const auto& to = regressor.kind == SignalKind::kOutput  ? outputs
                         : regressor.kind == SignalKind::kInput ? inputs
                                                                : disturbances;
        regressor.index = to[static_cast<std::size_t>(regressor.index)];
      }
  return matched;
}

}  // namespace fpc
