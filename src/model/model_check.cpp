#include "model/model_check.hpp"

#include <cmath>
#include <limits>

#include "base/decompositions.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/local_model.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {

double largestPole(const TsModel& model, const Measurement& at) {
  LocalModel local(asIdentified(model));  // nothing moves an unmeasured disturbance: no pole of it
  Vector state(local.stateSize()),
      loads = Vector::Zero(static_cast<Eigen::Index>(local.model().disturbances.size()));
  loads.head(at.disturbances.size()) = at.disturbances;
  local.restState(at.outputs, at.input_applied, loads, state);
  local.blend(state, loads);
  const Matrix& A = local.affine().A;
  if (!A.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::EigenSolver<Matrix> solver = eigenOf(A);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

void requireStable(const TsModel& model, const Measurement& at, double limit) {
  if (std::isinf(limit)) return;
  const double pole = largestPole(model, at);
  require(pole <= limit + 1e-9, "model '" + model.name + "'",
          "a model that is stable at the present sample: poles up to model.max_pole " +
              exactText(limit) + ", got " + exactText(std::round(1e6 * pole) / 1e6));
}

}  // namespace fpc
