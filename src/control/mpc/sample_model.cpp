#include "control/mpc/sample_model.hpp"

namespace fpc {

FuzzySampleModel::FuzzySampleModel(const TsModel& model)
    : local_(model), next_(local_.stateSize()) {}

void FuzzySampleModel::rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
                            Eigen::Ref<Vector> state) {
  local_.restState(outputs, input, disturbances, state);
}

bool FuzzySampleModel::step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) {
  local_.advance(state, input, disturbances, next_);
  state = next_;
  return state.allFinite();
}

}  // namespace fpc
