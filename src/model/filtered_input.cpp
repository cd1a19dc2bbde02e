#include "model/filtered_input.hpp"

#include <algorithm>
#include <utility>

namespace fpc {
namespace {

using Eigen::Index;

/// Its place among the regressors of the model; a new one has coefficients of 0.
Index placeOf(OutputModel& model, const Regressor& regressor) {
  const auto found = std::find(model.regressors.begin(), model.regressors.end(), regressor);
  const auto place = static_cast<Index>(found - model.regressors.begin());
  if (found != model.regressors.end()) return place;
  model.regressors.push_back(regressor);
  for (Rule& rule : model.rules) {
    rule.coefficients.conservativeResize(place + 1);
    rule.coefficients[place] = 0.0;
  }
  return place;
}

}  // namespace

void filterRegressor(OutputModel& model, SignalKind kind, int index, VectorRef response) {
  const std::vector<Regressor> before = model.regressors;
  std::vector<Vector> coefficients;
  for (Rule& rule : model.rules) coefficients.push_back(rule.coefficients);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].kind == kind && before[i].index == index)
      for (Rule& rule : model.rules) rule.coefficients[static_cast<Index>(i)] = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].kind != kind || before[i].index != index) continue;
    for (Index j = 0; j < response.size(); ++j) {
      const Index place = placeOf(model, {kind, index, before[i].lag + static_cast<int>(j)});
      for (std::size_t r = 0; r < model.rules.size(); ++r)
        model.rules[r].coefficients[place] += response[j] * coefficients[r][static_cast<Index>(i)];
    }
  }
}

}  // namespace fpc
