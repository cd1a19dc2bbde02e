#include "model/model_inputs.hpp"

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

bool knowsInput(const TsModel& model, int input) {
  for (const OutputModel& submodel : model.submodels)
    for (const Regressor& regressor : submodel.regressors)
      if (regressor.kind == SignalKind::kInput && regressor.index == input) return true;
  return false;
}

}  // namespace fpc
