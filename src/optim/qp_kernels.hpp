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

/// M -= x y'; columns with y(j) = 0 are left alone.
void subtractOuter(const double* x, Eigen::Index rows, const double* y, Eigen::Index columns,
                   double* M, Eigen::Index stride);

/// (a, b) = (cosine a + sine b, cosine b - sine a), n numbers each.
void rotate(double* a, double* b, Eigen::Index n, double cosine, double sine);

/// T = L^-T, n n each; what L has above its diagonal is not looked at.
void inverseTransposed(const double* L, Eigen::Index n, double* T);

/// sums(i) += sum_j |M(i, j)|
void addAbsolute(const double* M, Eigen::Index rows, Eigen::Index columns, double* sums);

/// sums(i) += sum_j (weight(j) M(i, j))^2
void addSquares(const double* M, Eigen::Index rows, Eigen::Index columns, const double* weight,
                double* sums);

/// row_largest(i) = max(row_largest(i), scale |column(i)|). @return max_i row_scale(i) |column(i)|
double largestOf(const double* column, Eigen::Index rows, const double* row_scale, double scale,
                 double* row_largest);

/// L L' = what L holds on and below its diagonal. @return false at a pivot that is not above the
/// least
bool choleskyInPlace(double* L, Eigen::Index stride, Eigen::Index n, const double* least_pivot);

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
