#include "analysis/rule_models.hpp"

#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {
namespace {

void requireSizes(const TsModel& model, VectorRef disturbances) {
  require(disturbances.size() == static_cast<Eigen::Index>(model.disturbances.size()) &&
              disturbances.allFinite(),
          model.name + ".disturbances",
          std::to_string(model.disturbances.size()) + " finite values");
}

Matrix previousInput(const LocalModel& local) {
  const auto n_u = static_cast<Eigen::Index>(local.model().inputs.size());
  Matrix E = Matrix::Zero(n_u, local.stateSize());
  for (Eigen::Index j = 0; j < n_u; ++j) E(j, local.inputState(j, 1)) = 1.0;
  return E;
}

}  // namespace

std::vector<RuleChoice> ruleChoices(const TsModel& model) {
  std::vector<RuleChoice> all{RuleChoice{}};
  for (const auto& submodel : model.submodels) {
    std::vector<RuleChoice> longer;
    for (const auto& choice : all)
      for (std::size_t r = 0; r < submodel.rules.size(); ++r) {
        longer.push_back(choice);
        longer.back().push_back(r);
      }
    all = std::move(longer);
  }
  return all;
}

std::string text(const RuleChoice& choice) {
  std::string s;
  for (const std::size_t rule : choice) s += (s.empty() ? "" : "/") + std::to_string(rule + 1);
  return s;
}

LinearModel ruleModel(const TsModel& model, const RuleChoice& choice, VectorRef disturbances) {
  requireSizes(model, disturbances);
  require(choice.size() == model.submodels.size(), "rules", "one rule for each output");
  TsModel alone = model;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    require(choice[i] < model.submodels[i].rules.size(), "rules",
            "a rule that " + model.outputs[i].name + " has");
    alone.submodels[i].rules = {model.submodels[i].rules[choice[i]]};
  }
  LocalModel local(std::move(alone));
  local.blend(Vector::Zero(local.stateSize()), disturbances);
  return {local.affine(), previousInput(local)};
}

LinearModel blendedModel(const TsModel& model, VectorRef outputs, VectorRef input,
                         VectorRef disturbances) {
  requireSizes(model, disturbances);
  require(outputs.size() == static_cast<Eigen::Index>(model.outputs.size()) && outputs.allFinite(),
          model.name + ".outputs", std::to_string(model.outputs.size()) + " finite values");
  require(input.size() == static_cast<Eigen::Index>(model.inputs.size()) && input.allFinite(),
          model.name + ".inputs", std::to_string(model.inputs.size()) + " finite values");
  LocalModel local(model);
  Vector rest(local.stateSize());
  local.restState(outputs, input, disturbances, rest);
  local.blend(rest, disturbances);
  return {local.affine(), previousInput(local)};
}

}  // namespace fpc
