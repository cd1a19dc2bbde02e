// Private: the kernels of cluster_kernels.hpp for vectors of two, four or eight numbers. They are
// inlined into functions compiled for a processor that has such vectors. Tiles of the triangular
// products are kept in registers, so that the arithmetic and not the loads take the time.
#pragma once

#include "identification/cluster_kernels.hpp"

#define FPC_INLINE __attribute__((always_inline)) inline
#define FPC_UNROLL _Pragma("GCC unroll 8")

namespace fpc::clusters {

// As many samples, wherever they lie in memory; a tile of the scatter has four rows by kColumns, a
// tile of the distances four rows by kVectors: 16 registers, with eight numbers 32.
// For clang: an alias (using) would lose the alignment, and so would a reference to it.
struct Two {
  // NOLINTNEXTLINE(modernize-use-using)
  typedef double Lanes __attribute__((vector_size(16), aligned(8), may_alias));
  static constexpr std::size_t kCount = 2;
  static constexpr int kColumns = 2, kVectors = 2;
};
struct Four {
  // NOLINTNEXTLINE(modernize-use-using)
  typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));
  static constexpr std::size_t kCount = 4;
  static constexpr int kColumns = 2, kVectors = 2;
};
struct Eight {
  // NOLINTNEXTLINE(modernize-use-using)
  typedef double Lanes __attribute__((vector_size(64), aligned(8), may_alias));
  static constexpr std::size_t kCount = 8;
  static constexpr int kColumns = 4, kVectors = 4;
};
static_assert(alignof(Four::Lanes) == alignof(double) && alignof(Eight::Lanes) == alignof(double));
static_assert(kLanes == Four::kCount && kBlock % (4 * Eight::kCount) == 0);

template <class V>
FPC_INLINE const typename V::Lanes* lanes(const double* p) {
  return reinterpret_cast<const typename V::Lanes*>(p);
}
template <class V>
FPC_INLINE typename V::Lanes* lanes(double* p) {
  return reinterpret_cast<typename V::Lanes*>(p);
}

/// Onto kLanes partial sums.
FPC_INLINE void addTo(double* sums, const Two::Lanes& s) { *lanes<Two>(sums) += s; }
FPC_INLINE void addTo(double* sums, const Four::Lanes& s) { *lanes<Four>(sums) += s; }
FPC_INLINE void addTo(double* sums, const Eight::Lanes& s) {
  const auto* halves = reinterpret_cast<const Four::Lanes*>(&s);
  *lanes<Four>(sums) += halves[0] + halves[1];
}

/// Whether the last tile has so few rows that two of them are enough.
FPC_INLINE bool shortTile(std::size_t n, std::size_t row) { return row + 2 >= n; }

/// sum += |(M away)(i to i + R)|^2, away = x - center, M lower triangular.
template <class V, int R>
FPC_INLINE void addNorms(const double* x, const double* center, const double* M, std::size_t n,
                         std::size_t i, typename V::Lanes* sum) {
  constexpr int kVectors = V::kVectors;
  const std::size_t rows = padded(n);
  const double* row = M + i * rows;
  typename V::Lanes a[R][kVectors] = {}, away[kVectors];
  for (std::size_t j = 0; j < i; ++j, x += kBlock) {
    FPC_UNROLL for (int v = 0; v < kVectors; ++v) {
      away[v] = lanes<V>(x)[v] - center[j];
      FPC_UNROLL for (int r = 0; r < R; ++r) a[r][v] += row[std::size_t(r) * rows + j] * away[v];
    }
  }
  FPC_UNROLL for (int d = 0; d < R; ++d, x += kBlock) {
    const std::size_t j = i + std::size_t(d);
    if (j >= n) break;
    FPC_UNROLL for (int v = 0; v < kVectors; ++v) {
      away[v] = lanes<V>(x)[v] - center[j];
      FPC_UNROLL for (int r = d; r < R; ++r) a[r][v] += row[std::size_t(r) * rows + j] * away[v];
    }
  }
  FPC_UNROLL for (int v = 0; v < kVectors; ++v) {
    FPC_UNROLL for (int r = 0; r < R; ++r) sum[v] += a[r][v] * a[r][v];
  }
}

template <class V>
FPC_INLINE void squaredNormsBy(const double* points, const double* center, const double* M,
                               std::size_t n, double* squared) {
  for (std::size_t s = 0; s < kBlock; s += V::kVectors * V::kCount) {
    typename V::Lanes sum[V::kVectors] = {};
    for (std::size_t i = 0; i < n; i += kTile) {
      if (shortTile(n, i))
        addNorms<V, 2>(points + s, center, M, n, i, sum);
      else
        addNorms<V, 4>(points + s, center, M, n, i, sum);
    }
    FPC_UNROLL for (int v = 0; v < V::kVectors; ++v) lanes<V>(squared + s)[v] = sum[v];
  }
}

template <class V>
FPC_INLINE void approachBy(const double* points, const double* center, std::size_t n,
                           double* nearest) {
  using Lanes = typename V::Lanes;
  for (std::size_t s = 0; s < kBlock; s += V::kCount) {
    Lanes squared{};
    for (std::size_t j = 0; j < n; ++j) {
      const Lanes away = *lanes<V>(points + j * kBlock + s) - center[j];
      squared += away * away;
    }
    const Lanes before = *lanes<V>(nearest + s);
    *lanes<V>(nearest + s) = squared < before ? squared : before;
  }
}

template <class V>
FPC_INLINE double shareOutBy(const double* squared, std::size_t clusters, double* member,
                             double* present) {
  using Lanes = typename V::Lanes;
  const Lanes whole = Lanes{} + 1.0;
  Lanes largest{};
  for (std::size_t s = 0; s < kBlock; s += V::kCount) {
    Lanes nearest = *lanes<V>(squared + s), sum{};
    for (std::size_t i = s + kBlock; i < clusters * kBlock; i += kBlock) {
      const Lanes other = *lanes<V>(squared + i);
      nearest = other < nearest ? other : nearest;
    }
    for (std::size_t i = s; i < clusters * kBlock; i += kBlock) {
      const Lanes distance = *lanes<V>(squared + i), share = nearest / distance;
      const Lanes u = distance <= nearest ? whole : share;
      *lanes<V>(member + i) = u;
      sum += u;
    }
    const Lanes scale = 1.0 / sum;
    for (std::size_t i = s; i < clusters * kBlock; i += kBlock) {
      const Lanes u = scale * *lanes<V>(member + i), move = u - *lanes<V>(present + i);
      const Lanes size = move < 0.0 ? -move : move;
      largest = size > largest ? size : largest;
      *lanes<V>(member + i) = u;
      *lanes<V>(present + i) = u;
    }
  }
  double most = 0.0;
  for (std::size_t v = 0; v < V::kCount; ++v) most = largest[v] > most ? largest[v] : most;
  return most;
}

template <class V>
FPC_INLINE void scaleBlockBy(const double* points, const double* center, const double* root,
                             const double* squared, std::size_t n, double* scaled, double* offset,
                             double* sums) {
  using Lanes = typename V::Lanes;
  constexpr int kKept = 8;  // weights in registers
  for (std::size_t s = 0; s < kBlock; s += kKept * V::kCount) {
    Lanes r[kKept], total{}, objective{};
    FPC_UNROLL for (int k = 0; k < kKept; ++k) {
      r[k] = lanes<V>(root + s)[k];
      const Lanes weight = r[k] * r[k];
      total += weight;
      objective += weight * lanes<V>(squared + s)[k];
    }
    addTo(sums, total);
    addTo(sums + kLanes, objective);
    for (std::size_t i = 0; i < n; ++i) {
      const typename V::Lanes* x = lanes<V>(points + i * kBlock + s);
      typename V::Lanes* to = lanes<V>(scaled + i * kBlock + s);
      Lanes sum[2] = {};
      FPC_UNROLL for (int k = 0; k < kKept; ++k) {
        const Lanes moved = r[k] * (x[k] - center[i]);
        to[k] = moved;
        sum[k % 2] += r[k] * moved;
      }
      addTo(offset + i * kLanes, sum[0] + sum[1]);
    }
  }
}

/// entry += x y', R rows of x by C of y; on the diagonal (y = x, R = C) the lower triangle.
template <class V, int R, int C, bool kDiagonal>
FPC_INLINE void addTile(const double* x, const double* y, double* entry, std::size_t stride) {
  typename V::Lanes sum[R][C] = {}, b[C];
  for (std::size_t s = 0; s < kBlock; s += V::kCount) {
    FPC_UNROLL for (int c = 0; c < C; ++c) b[c] = *lanes<V>(y + std::size_t(c) * kBlock + s);
    FPC_UNROLL for (int r = 0; r < R; ++r) {
      const typename V::Lanes a = kDiagonal ? b[r % C] : *lanes<V>(x + std::size_t(r) * kBlock + s);
      FPC_UNROLL for (int c = 0; c < (kDiagonal ? r + 1 : C); ++c) sum[r][c] += a * b[c];
    }
  }
  FPC_UNROLL for (int r = 0; r < R; ++r, entry += stride) {
    FPC_UNROLL for (int c = 0; c < (kDiagonal ? r + 1 : C); ++c)
        addTo(entry + std::size_t(c) * kLanes, sum[r][c]);
  }
}

template <class V>
FPC_INLINE void addScatterBy(const double* scaled, std::size_t n, double* scatter) {
  constexpr int kColumns = V::kColumns;
  const std::size_t stride = padded(n) * kLanes;
  for (std::size_t i = 0; i < n; i += kTile) {
    const double* x = scaled + i * kBlock;
    double* row = scatter + i * stride;
    if (shortTile(n, i)) {
      for (std::size_t j = 0; j < i; j += 4)
        addTile<V, 2, 4, false>(x, scaled + j * kBlock, row + j * kLanes, stride);
      addTile<V, 2, 2, true>(x, x, row + i * kLanes, stride);
    } else {
      for (std::size_t j = 0; j < i; j += kColumns)
        addTile<V, 4, kColumns, false>(x, scaled + j * kBlock, row + j * kLanes, stride);
      addTile<V, 4, 4, true>(x, x, row + i * kLanes, stride);
    }
  }
}

}  // namespace fpc::clusters
