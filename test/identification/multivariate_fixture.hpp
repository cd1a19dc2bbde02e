// Models whose rules have multivariate memberships.
#pragma once

#include "identification/model_fixture.hpp"

namespace fpc::test {

/// The model with bells on all variables at once in the place of its sets: the same model where the
/// sets are Gaussian, one of the same regions elsewhere.
inline TsModel multivariate(TsModel model) {
  for (auto& submodel : model.submodels)
    for (auto& rule : submodel.rules) {
      const auto n = static_cast<Eigen::Index>(rule.antecedents.size());
      MultivariateMembership set{Vector::Zero(n), Matrix::Zero(n, n)};
      for (Eigen::Index i = 0; i < n; ++i) {
        const Membership& one = rule.antecedents[static_cast<std::size_t>(i)];
        const auto& p = one.parameters;
        const bool bell = one.shape == MembershipShape::kGaussian;
        const double width = bell ? p[1] : 0.25 * (p.back() - p.front());
        set.center[i] = bell ? p[0] : 0.5 * (p.back() + p.front());
        set.inverse_covariance(i, i) = 1.0 / (width * width);
      }
      rule.antecedents.clear();
      rule.multivariate = set;
    }
  return model;
}

/// Symmetric, positive semidefinite, of this rank.
inline Matrix randomSemidefinite(std::mt19937_64& generator, Eigen::Index n, Eigen::Index rank) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Matrix root = Matrix::NullaryExpr(n, rank, [&] { return unit(generator); });
  Matrix S = root * root.transpose();
  S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
  return S;
}

}  // namespace fpc::test
