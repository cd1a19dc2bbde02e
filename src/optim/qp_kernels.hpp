// Private: products of matrices and vectors of a controller's size, for which a library's general
// product spends more on its preparation than on the work.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc::qp {

/// y += factor M x; M rows x columns, column by column `stride` apart, x `x_stride` apart.
void addProduct(double factor, const double* M, Eigen::Index stride, Eigen::Index rows,
                Eigen::Index columns, const double* x, Eigen::Index x_stride, double* y);

/// y = M'x
void transposedProduct(const double* M, Eigen::Index stride, Eigen::Index rows,
                       Eigen::Index columns, const double* x, double* y);

/// y += factor M x for blocks of matrices; x may be a row of one.
template <class Block, class X, class Y>
void addProduct(double factor, const Block& M, const X& x, Y&& y) {
  addProduct(factor, M.data(), M.outerStride(), M.rows(), M.cols(), x.data(),
             X::IsRowMajor && !X::IsVectorAtCompileTime ? x.outerStride() : x.innerStride(),
             y.data());
}

/// y = M x
template <class Block, class X, class Y>
void product(const Block& M, const X& x, Y&& y) {
  y.setZero();
  addProduct(1.0, M, x, y);
}

/// y = M'x
template <class Block, class X, class Y>
void transposedProduct(const Block& M, const X& x, Y&& y) {
  transposedProduct(M.data(), M.outerStride(), M.rows(), M.cols(), x.data(), y.data());
}

}  // namespace fpc::qp
