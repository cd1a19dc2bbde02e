// Compiled for the processor at hand and for any: the loader picks (function multiversioning).
#include "optim/qp_kernels.hpp"

#include <cmath>

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

FPC_TARGET_CLONES
void subtractOuter(const double* x, Index rows, const double* y, Index columns, double* M,
                   Index stride) {
  for (Index j = 0; j < columns; ++j, M += stride) {
    const double factor = y[j];
    if (factor == 0.0) continue;
    Index i = 0;
    for (; i + 2 * kLanes <= rows; i += 2 * kLanes) {
      *lanes(M + i) -= factor * *lanes(x + i);
      *lanes(M + i + kLanes) -= factor * *lanes(x + i + kLanes);
    }
    for (; i < rows; ++i) M[i] -= factor * x[i];
  }
}

FPC_TARGET_CLONES
void rotate(double* a, double* b, Index n, double cosine, double sine) {
  Index i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes p = *lanes(a + i), q = *lanes(b + i);
    *lanes(a + i) = cosine * p + sine * q;
    *lanes(b + i) = cosine * q - sine * p;
  }
  for (; i < n; ++i) {
    const double p = a[i], q = b[i];
    a[i] = cosine * p + sine * q;
    b[i] = cosine * q - sine * p;
  }
}

// Column j is -1/L_jj times the columns before it, weighted with row j of L; T is zero below its
// diagonal, so rows from i on need the columns from i on.
FPC_TARGET_CLONES
void inverseTransposed(const double* L, Index n, double* T) {
  for (Index j = 0; j < n; ++j) {
    const double diagonal = 1.0 / L[j + j * n];
    double* column = T + j * n;
    Index i = 0;
    for (; i < j && i + 2 * kLanes <= n; i += 2 * kLanes) {
      Lanes a{}, b{};
      const double* from = T + i + i * n;
      for (Index k = i; k < j; ++k, from += n) {
        const double x = L[j + k * n];
        a += x * *lanes(from);
        b += x * *lanes(from + kLanes);
      }
      *lanes(column + i) = -diagonal * a;
      *lanes(column + i + kLanes) = -diagonal * b;
    }
    for (; i < j; ++i) {
      double sum = 0.0;
      for (Index k = i; k < j; ++k) sum += L[j + k * n] * T[i + k * n];
      column[i] = -diagonal * sum;
    }
    column[j] = diagonal;
    for (i = j + 1; i < n; ++i) column[i] = 0.0;
  }
}

FPC_TARGET_CLONES
void addAbsolute(const double* M, Index rows, Index columns, double* sums) {
  Index i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    Lanes sum{};
    const double* from = M + i;
    for (Index j = 0; j < columns; ++j, from += rows) {
      const Lanes a = *lanes(from);
      sum += a < 0.0 ? -a : a;
    }
    *lanes(sums + i) += sum;
  }
  for (; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j)
      sums[i] += M[i + j * rows] < 0.0 ? -M[i + j * rows] : M[i + j * rows];
  }
}

FPC_TARGET_CLONES
void addSquares(const double* M, Index rows, Index columns, const double* weight, double* sums) {
  Index i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    Lanes sum{};
    const double* from = M + i;
    for (Index j = 0; j < columns; ++j, from += rows) {
      const Lanes a = weight[j] * *lanes(from);
      sum += a * a;
    }
    *lanes(sums + i) += sum;
  }
  for (; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      const double a = weight[j] * M[i + j * rows];
      sums[i] += a * a;
    }
  }
}

FPC_TARGET_CLONES
double largestOf(const double* column, Index rows, const double* row_scale, double scale,
                 double* row_largest) {
  Lanes most{};
  Index i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    const Lanes v = *lanes(column + i), size = v < 0.0 ? -v : v;
    const Lanes in_column = size * *lanes(row_scale + i), in_row = scale * size;
    const Lanes before = *lanes(row_largest + i);
    most = in_column > most ? in_column : most;
    *lanes(row_largest + i) = in_row > before ? in_row : before;
  }
  double largest = 0.0;
  for (Index k = 0; k < kLanes; ++k) largest = most[k] > largest ? most[k] : largest;
  for (; i < rows; ++i) {
    const double size = column[i] < 0.0 ? -column[i] : column[i];
    if (size * row_scale[i] > largest) largest = size * row_scale[i];
    if (size * scale > row_largest[i]) row_largest[i] = size * scale;
  }
  return largest;
}

// Left-looking; what the first columns have taken from the rest of a column is summed in registers.
FPC_TARGET_CLONES
bool choleskyInPlace(double* L, Index stride, Index n, const double* least_pivot) {
  for (Index j = 0; j < n; ++j) {
    double* column = L + j * stride;
    const double* row = L + j;
    Index i = j;
    for (; i + 4 * kLanes <= n; i += 4 * kLanes) {
      Lanes a{}, b{}, c{}, d{};
      for (Index k = 0; k < j; ++k) {
        const double x = row[k * stride];
        const double* from = L + i + k * stride;
        a += x * *lanes(from);
        b += x * *lanes(from + kLanes);
        c += x * *lanes(from + 2 * kLanes);
        d += x * *lanes(from + 3 * kLanes);
      }
      *lanes(column + i) -= a;
      *lanes(column + i + kLanes) -= b;
      *lanes(column + i + 2 * kLanes) -= c;
      *lanes(column + i + 3 * kLanes) -= d;
    }
    for (; i + kLanes <= n; i += kLanes) {
      Lanes a{};
      for (Index k = 0; k < j; ++k) a += row[k * stride] * *lanes(L + i + k * stride);
      *lanes(column + i) -= a;
    }
    for (; i < n; ++i) {
      double a = 0.0;
      for (Index k = 0; k < j; ++k) a += row[k * stride] * L[i + k * stride];
      column[i] -= a;
    }
    const double pivot = column[j];
    if (!(pivot > least_pivot[j]) || !std::isfinite(pivot)) return false;
    const double factor = 1.0 / std::sqrt(pivot);
    for (i = j; i < n; ++i) column[i] *= factor;
  }
  return true;
}

}  // namespace fpc::qp
