// Compiled for the processor at hand and for any: the loader picks (function multiversioning).
#include "optim/qp_kernels.hpp"

#include "base/target_clones.hpp"

namespace fpc::qp {
namespace {

using Eigen::Index;
// Four numbers, wherever they lie in memory.
// For clang: an alias (using) would lose the alignment, and so would a reference to it.
// NOLINTNEXTLINE(modernize-use-using)
typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(Lanes) == alignof(double));
constexpr Index kLanes = 4;

inline const Lanes* lanes(const double* p) { return reinterpret_cast<const Lanes*>(p); }
inline Lanes* lanes(double* p) { return reinterpret_cast<Lanes*>(p); }

}  // namespace

// Rows go by sixteen, four and one, with the sums of a block in registers over all columns; even
// and odd columns have sums of their own, so that one need not wait for the other.
FPC_TARGET_CLONES
void addProduct(double factor, const double* M, Index stride, Index rows, Index columns,
                const double* x, Index x_stride, double* y) {
  const Index pairs = columns / 2 * 2;
  Index i = 0;
  for (; i + 4 * kLanes <= rows; i += 4 * kLanes) {
    Lanes a0{}, a1{}, a2{}, a3{}, b0{}, b1{}, b2{}, b3{};
    const double* column = M + i;
    for (Index j = 0; j < pairs; j += 2, column += 2 * stride) {
      const double xa = x[j * x_stride], xb = x[(j + 1) * x_stride];
      const double* next = column + stride;
      a0 += xa * *lanes(column);
      a1 += xa * *lanes(column + kLanes);
      a2 += xa * *lanes(column + 2 * kLanes);
      a3 += xa * *lanes(column + 3 * kLanes);
      b0 += xb * *lanes(next);
      b1 += xb * *lanes(next + kLanes);
      b2 += xb * *lanes(next + 2 * kLanes);
      b3 += xb * *lanes(next + 3 * kLanes);
    }
    if (pairs < columns) {
      const double xa = x[pairs * x_stride];
      a0 += xa * *lanes(column);
      a1 += xa * *lanes(column + kLanes);
      a2 += xa * *lanes(column + 2 * kLanes);
      a3 += xa * *lanes(column + 3 * kLanes);
    }
    *lanes(y + i) += factor * (a0 + b0);
    *lanes(y + i + kLanes) += factor * (a1 + b1);
    *lanes(y + i + 2 * kLanes) += factor * (a2 + b2);
    *lanes(y + i + 3 * kLanes) += factor * (a3 + b3);
  }
  for (; i + kLanes <= rows; i += kLanes) {
    Lanes a{}, b{};
    const double* column = M + i;
    for (Index j = 0; j < pairs; j += 2, column += 2 * stride) {
      a += x[j * x_stride] * *lanes(column);
      b += x[(j + 1) * x_stride] * *lanes(column + stride);
    }
    if (pairs < columns) a += x[pairs * x_stride] * *lanes(column);
    *lanes(y + i) += factor * (a + b);
  }
  for (; i < rows; ++i) {
    double a = 0.0, b = 0.0;
    const double* entry = M + i;
    for (Index j = 0; j < pairs; j += 2, entry += 2 * stride) {
      a += x[j * x_stride] * entry[0];
      b += x[(j + 1) * x_stride] * entry[stride];
    }
    if (pairs < columns) a += x[pairs * x_stride] * entry[0];
    y[i] += factor * (a + b);
  }
}

FPC_TARGET_CLONES
void transposedProduct(const double* M, Index stride, Index rows, Index columns, const double* x,
                       double* y) {
  Index j = 0;
  for (; j + 3 < columns; j += 4, M += 4 * stride) {
    const double *b = M + stride, *c = b + stride, *d = c + stride;
    Lanes sa{}, sb{}, sc{}, sd{};
    Index i = 0;
    for (; i + kLanes <= rows; i += kLanes) {
      const Lanes v = *lanes(x + i);
      sa += *lanes(M + i) * v;
      sb += *lanes(b + i) * v;
      sc += *lanes(c + i) * v;
      sd += *lanes(d + i) * v;
    }
    double ya = (sa[0] + sa[1]) + (sa[2] + sa[3]), yb = (sb[0] + sb[1]) + (sb[2] + sb[3]);
    double yc = (sc[0] + sc[1]) + (sc[2] + sc[3]), yd = (sd[0] + sd[1]) + (sd[2] + sd[3]);
    for (; i < rows; ++i) {
      ya += M[i] * x[i];
      yb += b[i] * x[i];
      yc += c[i] * x[i];
      yd += d[i] * x[i];
    }
    y[j] = ya;
    y[j + 1] = yb;
    y[j + 2] = yc;
    y[j + 3] = yd;
  }
  for (; j < columns; ++j, M += stride) {
    Lanes sum{};
    Index i = 0;
    for (; i + kLanes <= rows; i += kLanes) sum += *lanes(M + i) * *lanes(x + i);
    double value = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    for (; i < rows; ++i) value += M[i] * x[i];
    y[j] = value;
  }
}

}  // namespace fpc::qp
