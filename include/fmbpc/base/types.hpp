// Short names for the matrices that every room uses.
#pragma once

#include <Eigen/Core>

namespace fpc {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using VectorRef = Eigen::Ref<const Vector>;
using MatrixRef = Eigen::Ref<const Matrix>;

}  // namespace fpc
