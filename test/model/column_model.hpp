// The Wood-Berry column as a model of controllers: numbers of eq. 27 of mekki.
#pragma once

#include <limits>

#include "model/linear_model.hpp"

namespace fpc::test {

inline FopdtMatrix columnMatrix() {
  return {{{{{12.8, 16.7, 1.0}, {-18.9, 21.0, 3.0}}}, {{{6.6, 10.9, 7.0}, {-19.4, 14.4, 3.0}}}}};
}

/// At the sample time given; `feed`: with the feed as a measured disturbance.
inline TsModel columnModel(double sample_time_s, bool feed) {
  const double infinite = std::numeric_limits<double>::infinity();
  TsModel names;
  names.name = feed ? "wood_berry_feed" : "wood_berry";
  names.source = "wood1973, exact for inputs held over a sample of one minute.";
  names.sample_time_s = sample_time_s;
  names.outputs = {{"y_D", "mol%", -infinite, infinite}, {"x_B", "mol%", -infinite, infinite}};
  names.inputs = {{"L", "lb/min", -infinite, infinite}, {"V", "lb/min", -infinite, infinite}};
  if (feed) names.disturbances = {{"F", "lb/min", -infinite, infinite}};
  std::vector<LinearElement> elements;
  const FopdtMatrix matrix = columnMatrix();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j)
      elements.push_back({i, SignalKind::kInput, j,
                          matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]});
    if (feed)
      elements.push_back(
          {i, SignalKind::kDisturbance, 0, i == 0 ? Fopdt{3.8, 14.9, 8.0} : Fopdt{4.9, 13.2, 3.0}});
  }
  LinearPoint point{(Vector(2) << 96.25, 0.5).finished(), Vector::Zero(2),
                    Vector::Zero(feed ? 1 : 0)};
  return linearModel(names, elements, point);
}

}  // namespace fpc::test
