#include "model/canonical_form.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

CanonicalForm::CanonicalForm(const TsModel& model) {
  const Eigen::Index n = model.maxLag(SignalKind::kOutput, 0) + 1;
  const bool single =
      model.outputs.size() == 1 && model.inputs.size() == 1 && model.disturbances.empty();
  const Eigen::Index n_b = single ? model.maxLag(SignalKind::kInput, 0) + 1 : 0;
  require(single && n_b >= 1 && n_b < n, "controller.realisation",
          "parallel or realigned: literal takes one output, one input without delay, no "
          "disturbance, and fewer lags of the input than of the output");
  affine_ = AffineModel(n, 1, 1);
  affine_.B(n - 1, 0) = 1.0;
  for (Eigen::Index i = 0; i + 1 < n; ++i) affine_.A(i, i + 1) = 1.0;
  const OutputModel& submodel = model.submodels.front();
  for (const Rule& rule : submodel.rules) {
    Row row{Vector::Zero(n), Vector::Zero(n_b), 0.0};
    for (std::size_t i = 0; i < submodel.regressors.size(); ++i) {
      const Regressor& regressor = submodel.regressors[i];
      Vector& part = regressor.kind == SignalKind::kOutput ? row.output : row.input;
      part[regressor.lag] = rule.coefficients[static_cast<Eigen::Index>(i)];
    }
    row.offset = rule.offset / row.input.sum();
    require(std::isfinite(row.offset), "controller.realisation",
            "parallel or realigned: in a rule of model '" + model.name +
                "' the input has no effect, which literal divides by");
    rules_.push_back(row);
  }
}

void CanonicalForm::blend(const FiringResult& firing) {
  const Eigen::Index n = affine_.g.size();
  affine_.A.row(n - 1).setZero();
  affine_.C.setZero();
  affine_.g.setZero();
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const double weight = firing.weights[static_cast<Eigen::Index>(r)];
    const Row& rule = rules_[r];
    for (Eigen::Index lag = 0; lag < n; ++lag)
      affine_.A(n - 1, n - 1 - lag) += weight * rule.output[lag];
    for (Eigen::Index lag = 0; lag < rule.input.size(); ++lag)
      affine_.C(0, n - 2 - lag) += weight * rule.input[lag];
    affine_.g[n - 1] += weight * rule.offset;
  }
}

void CanonicalForm::restState(double input, Eigen::Ref<Vector> state) const {
  const Eigen::Index last = affine_.g.size() - 1;
  state.setConstant((input + affine_.g[last]) / (1.0 - affine_.A.row(last).sum()));
}

}  // namespace fpc
