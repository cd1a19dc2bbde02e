// Compiled for the processor at hand and for any: the loader picks (function multiversioning). Four
// rows by two vectors are kept in registers, so that the arithmetic and not the loads take the
// time.
#include "fuzzy/cluster_kernels.hpp"

#include "base/target_clones.hpp"

namespace fpc::clusters {
namespace {

// Four samples, wherever they lie in memory.
// For clang: an alias (using) would lose the alignment, and so would a reference to it.
// NOLINTNEXTLINE(modernize-use-using)
typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(Lanes) == alignof(double));
constexpr std::size_t kLanes = 4;

inline const Lanes* lanes(const double* p) { return reinterpret_cast<const Lanes*>(p); }
inline Lanes* lanes(double* p) { return reinterpret_cast<Lanes*>(p); }

}  // namespace

FPC_TARGET_CLONES
void subtract(const double* points, const double* center, std::size_t n, double* away) {
  for (std::size_t j = 0; j < n; ++j) {
    const double c = center[j];
    for (std::size_t s = j * kBlock; s < (j + 1) * kBlock; s += kLanes)
      *lanes(away + s) = *lanes(points + s) - c;
  }
}

FPC_TARGET_CLONES
void squaredNorms(const double* away, const double* M, std::size_t n, double* squared) {
  const std::size_t rows = padded(n);
  for (std::size_t s = 0; s < kBlock; s += 2 * kLanes) {
    Lanes sum0{}, sum1{};
    for (std::size_t i = 0; i < rows; i += kTile) {
      const double* row = M + i * rows;
      Lanes a0{}, b0{}, c0{}, d0{}, a1{}, b1{}, c1{}, d1{};
      for (std::size_t j = 0; j < i + kTile; ++j) {
        const Lanes x0 = *lanes(away + j * kBlock + s), x1 = *lanes(away + j * kBlock + s + kLanes);
        const double a = row[j], b = row[rows + j], c = row[2 * rows + j], d = row[3 * rows + j];
        a0 += a * x0;
        a1 += a * x1;
        b0 += b * x0;
        b1 += b * x1;
        c0 += c * x0;
        c1 += c * x1;
        d0 += d * x0;
        d1 += d * x1;
      }
      sum0 += (a0 * a0 + b0 * b0) + (c0 * c0 + d0 * d0);
      sum1 += (a1 * a1 + b1 * b1) + (c1 * c1 + d1 * d1);
    }
    *lanes(squared + s) = sum0;
    *lanes(squared + s + kLanes) = sum1;
  }
}

FPC_TARGET_CLONES
void scaleBlock(const double* away, const double* weight, std::size_t n, double* scaled,
                double* sum) {
  for (std::size_t i = 0; i < n; ++i) {
    Lanes total{};
    for (std::size_t s = 0; s < kBlock; s += kLanes) {
      const Lanes product = *lanes(weight + s) * *lanes(away + i * kBlock + s);
      *lanes(scaled + i * kBlock + s) = product;
      total += product;
    }
    sum[i] += (total[0] + total[1]) + (total[2] + total[3]);
  }
}

FPC_TARGET_CLONES
void addScatter(const double* away, const double* scaled, std::size_t n, double* scatter) {
  const std::size_t rows = padded(n);
  for (std::size_t i = 0; i < rows; i += kTile) {
    for (std::size_t j = 0; j < i + kTile; j += 2) {
      const double *x = away + j * kBlock, *y = scaled + i * kBlock;
      Lanes a0{}, b0{}, c0{}, d0{}, a1{}, b1{}, c1{}, d1{};
      for (std::size_t s = 0; s < kBlock; s += kLanes) {
        const Lanes x0 = *lanes(x + s), x1 = *lanes(x + kBlock + s);
        const Lanes a = *lanes(y + s), b = *lanes(y + kBlock + s);
        const Lanes c = *lanes(y + 2 * kBlock + s), d = *lanes(y + 3 * kBlock + s);
        a0 += a * x0;
        a1 += a * x1;
        b0 += b * x0;
        b1 += b * x1;
        c0 += c * x0;
        c1 += c * x1;
        d0 += d * x0;
        d1 += d * x1;
      }
      double* entry = scatter + i * rows + j;
      const Lanes first[kTile] = {a0, b0, c0, d0}, second[kTile] = {a1, b1, c1, d1};
      for (std::size_t t = 0; t < kTile; ++t) {
        entry[t * rows] += (first[t][0] + first[t][1]) + (first[t][2] + first[t][3]);
        entry[t * rows + 1] += (second[t][0] + second[t][1]) + (second[t][2] + second[t][3]);
      }
    }
  }
}

}  // namespace fpc::clusters
