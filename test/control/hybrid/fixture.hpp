// The batch reactor's controller as published: inputs of eq. 43, costs of eqs. 44 and 45.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "config/model_file.hpp"
#include "control/hybrid/hybrid_mpc.hpp"
#include "fmbpc/model/model_match.hpp"
#include "paths.hpp"

namespace fpc::test {

inline PlantInfo batchReactorInfo() {
  PlantInfo info;
  info.name = "batch_reactor";
  info.sample_time_s = 10.0;
  info.outputs = {{"T", "degC", 0.0, 100.0}, {"Tw", "degC", 0.0, 100.0}};
  info.inputs = {{"kM", "-", 0.0, 1.0}, {"kC", "-", 0.0, 1.0}, {"kH", "-", 0.0, 1.0}};
  return info;
}

inline InputLimits batchReactorLimits() {
  return {Vector::Zero(3), Vector::Ones(3),
          Vector::Constant(3, std::numeric_limits<double>::infinity())};
}

inline Matrix batchReactorInputs() {
  Matrix P(3, 7);
  P << 0, 0.01, 0.02, 0.05, 0.1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0;
  return P;
}

inline HybridMpcParams batchReactorParams(int equation, BranchBound bound, int blocks = 4) {
  HybridMpcParams params;
  params.choices = batchReactorInputs();
  params.horizon_blocks = blocks;
  params.bound = bound;
  params.weight_tracking = Eigen::Vector2d(1.0, 0.0);
  if (equation == 44) return params;
  params.weight_tracking[0] = 1.0 / params.hold_samples;
  params.switching = {{2, 1, 15.0}};
  params.travel = {{0, 2, 0.03}};
  return params;
}

inline TsModel batchModel(const std::string& name) {
  return matchToPlant(readModel(sourceDir() + "/config/model/" + name + ".yaml"),
                      batchReactorInfo());
}

inline std::unique_ptr<HybridMpc> batchReactorMpc(HybridMpcParams params,
                                                  const std::string& model = "batch_fuzzy") {
  auto mpc =
      std::make_unique<HybridMpc>(std::move(params), batchReactorLimits(), batchReactorInfo());
  mpc->setModel(batchModel(model));
  return mpc;
}

}  // namespace fpc::test
