// Stage 4: models of the plant from what was seen of it, with what is not known of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "identification/process_fit.hpp"
#include "model/linear_model.hpp"
#include "plant/model_plant.hpp"
#include "runtime/commissioning/brief.hpp"
#include "runtime/commissioning/plant_record.hpp"

namespace fpc {

/// Outputs of the models may have a load: a disturbance that nobody measures, in the output's unit
/// (of integrators per hour) behind the lags of the strongest input.
std::string loadName(const std::string& output);

struct ProcessModels {
  std::vector<ProcessFit> fits;   ///< one per output: elements of inputs, then disturbances
  TsModel model;                  ///< the likeliest
  std::vector<TsModel> ensemble;  ///< equally likely ones
  Vector disturbance_moves;       ///< n_d measured ones: half of what each went through
};

/// `names` says name, sample time and signals; `members` of each fit's ensemble make one. `loads`:
/// n_y, outputs that have one. Disturbances that are measured have not moved.
ProcessModels modelsOf(const TsModel& names, const std::vector<ProcessFit>& fits, int members,
                       const std::vector<bool>& loads);

/// While the present control does not hold what was found, outputs called unstable, then those
/// called integrating, are taken for another kind. Where that does not help, the kinds that the
/// record shows stay. @throws InputError naming an output that no input moves.
ProcessModels findModels(const CommissioningBrief& brief, const PlantRecord& record, int members,
                         const std::function<bool(const ProcessModels&)>& holds);
/// The noise of the fits becomes that of the plant in operation, from row `first` of a record
/// without a test; `least`: n_y, of its one-step errors. Where that has too few rows the test's
/// stays.
void takeNoiseInOperation(const PlantRecord& watched, Eigen::Index first, const Vector& least,
                          ProcessModels& models);
/// Elements with their bounds, kinds and errors, those of the ensemble too.
OrderedJson toJson(const ProcessModels& models, const PlantInfo& plant);
/// model.yaml and ensemble/NUMBER.yaml, each a plant of type model.
void writeModels(const ProcessModels& models, const std::string& folder);
/// What writeModels() wrote, with model.json. @throws InputError naming the file.
ProcessModels readModels(const std::string& folder);

/// Where the models rest, whatever their gains.
LinearPoint modelRest(const std::vector<ProcessFit>& fits, Eigen::Index inputs);

/// A direction of the inputs, in parts of their ranges, that moves the outputs, in parts of theirs,
/// little beside the strongest one.
struct WeakDirection {
  Vector inputs;   ///< of length 1
  double share{};  ///< of the strongest one's gain
  bool certain{};  ///< its gain has the same sign in the whole ensemble
};
std::vector<WeakDirection> weakDirections(const ProcessModels& models, const Vector& input_range,
                                          const Vector& output_range);

}  // namespace fpc
