// Numbers of a judgement as JSON: what does not exist is null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "fmbpc/fuzzy/prediction.hpp"

namespace fpc::tool {

inline nlohmann::ordered_json finiteJson(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json figuresJson(const FitFigures& figures) {
  const auto known = [&](double value) {
    return figures.samples > 0 ? finiteJson(value) : nlohmann::ordered_json(nullptr);
  };
  return {{"rmse", known(figures.rmse)},
          {"mse", known(figures.mse)},
          {"vaf", known(figures.vaf)},
          {"fit", known(figures.fit)},
          {"samples", figures.samples}};
}

}  // namespace fpc::tool
