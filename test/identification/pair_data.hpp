// Data of one output y and one input u, as tests make them up.
#pragma once

#include "identification/data_set.hpp"

namespace fpc {

inline DataSet pairData(const Matrix& values, double sample_time_s = 1.0) {
  DataSet data;
  data.source = "made up";
  data.sample_time_s = sample_time_s;
  data.values = values;
  const auto info = [&](const char* name, Eigen::Index c) {
    return SignalInfo{name, "", values.col(c).minCoeff(), values.col(c).maxCoeff()};
  };
  data.outputs = {info("y", 0)};
  data.inputs = {info("u", 1)};
  data.constant.assign(2, false);
  return data;
}

}  // namespace fpc
