#include "runtime/plan.hpp"

#include <algorithm>

namespace fpc {

Matrix planOf(const PredictiveAction& action) {
  Matrix plan = action.feedforward;
  if (action.K.isZero(0.0)) return plan;
  Vector x = action.state;
  for (Eigen::Index i = 0; i < plan.cols(); ++i) {
    plan.col(i).noalias() -= action.K * x;
    x = (action.A * x + action.B * plan.col(i) + action.offset_state).eval();
  }
  return plan;
}

void takePlans(LinkInbox& inbox, const StepHeader& sample, const PlantInfo& plant,
               ControllerSession& session) {
  inbox.plans(sample.time_ns, [&](const std::string& name, VectorRef ahead) {
    for (std::size_t i = 0; i < plant.disturbances.size(); ++i)
      if (plant.disturbances[i].name == name)
        session.expect(sample.step, static_cast<Eigen::Index>(i), ahead);
  });
}

}  // namespace fpc
