// Numbers of a judgement as JSON: what does not exist is null.
#pragma once

#include "base/finite_json.hpp"
#include "identification/prediction.hpp"

namespace fpc::tool {

inline OrderedJson figuresJson(const FitFigures& figures) {
  const auto known = [&](double value) {
    return figures.samples > 0 ? numberOrNull(value) : OrderedJson(nullptr);
  };
  return {{"rmse", known(figures.rmse)},
          {"mse", known(figures.mse)},
          {"vaf", known(figures.vaf)},
          {"fit", known(figures.fit)},
          {"samples", figures.samples}};
}

}  // namespace fpc::tool
