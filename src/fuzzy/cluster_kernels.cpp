// Compiled for the processor at hand and for any: the loader picks (function multiversioning). Four
// rows by two vectors, or two by four, are kept in registers, so that the arithmetic and not the
// loads take the time.
#include "fuzzy/cluster_kernels.hpp"

#include "base/target_clones.hpp"

namespace fpc::clusters {
namespace {

// Four samples, wherever they lie in memory.
// For clang: an alias (using) would lose the alignment, and so would a reference to it.
// NOLINTNEXTLINE(modernize-use-using)
typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(Lanes) == alignof(double));
static_assert(sizeof(Lanes) == kLanes * sizeof(double) && kBlock % (4 * kLanes) == 0);

inline const Lanes* lanes(const double* p) { return reinterpret_cast<const Lanes*>(p); }
inline Lanes* lanes(double* p) { return reinterpret_cast<Lanes*>(p); }

/// Whether the last tile has so few rows that two of them are enough.
inline bool shortTile(std::size_t n, std::size_t row) { return row + 2 >= n; }

}  // namespace

FPC_TARGET_CLONES
void squaredNorms(const double* points, const double* center, const double* M, std::size_t n,
                  double* squared) {
  const std::size_t rows = padded(n);
  for (std::size_t s = 0; s < kBlock; s += 2 * kLanes) {
    Lanes sum0{}, sum1{};
    for (std::size_t i = 0; i < n; i += kTile) {
      const double* row = M + i * rows;
      const std::size_t last = i + kTile < n ? i + kTile : n;
      const double* x = points + s;
      Lanes a0{}, b0{}, a1{}, b1{};
      if (shortTile(n, i)) {
        for (std::size_t j = 0; j < last; ++j, x += kBlock) {
          const Lanes x0 = *lanes(x) - center[j], x1 = *lanes(x + kLanes) - center[j];
          const double a = row[j], b = row[rows + j];
          a0 += a * x0;
          a1 += a * x1;
          b0 += b * x0;
          b1 += b * x1;
        }
        sum0 += a0 * a0 + b0 * b0;
        sum1 += a1 * a1 + b1 * b1;
        continue;
      }
      Lanes c0{}, d0{}, c1{}, d1{};
      for (std::size_t j = 0; j < last; ++j, x += kBlock) {
        const Lanes x0 = *lanes(x) - center[j], x1 = *lanes(x + kLanes) - center[j];
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
void approach(const double* points, const double* center, std::size_t n, double* nearest) {
  for (std::size_t s = 0; s < kBlock; s += kLanes) {
    Lanes squared{};
    for (std::size_t j = 0; j < n; ++j) {
      const Lanes away = *lanes(points + j * kBlock + s) - center[j];
      squared += away * away;
    }
    const Lanes before = *lanes(nearest + s);
    *lanes(nearest + s) = squared < before ? squared : before;
  }
}

FPC_TARGET_CLONES
double shareOut(const double* squared, std::size_t clusters, double* member, double* present) {
  Lanes largest{};
  for (std::size_t s = 0; s < kBlock; s += kLanes) {
    Lanes nearest = *lanes(squared + s), sum{};
    for (std::size_t i = s + kBlock; i < clusters * kBlock; i += kBlock) {
      const Lanes other = *lanes(squared + i);
      nearest = other < nearest ? other : nearest;
    }
    for (std::size_t i = s; i < clusters * kBlock; i += kBlock) {
      const Lanes distance = *lanes(squared + i), share = nearest / distance;
      const Lanes u = distance <= nearest ? Lanes{1.0, 1.0, 1.0, 1.0} : share;
      *lanes(member + i) = u;
      sum += u;
    }
    const Lanes scale = 1.0 / sum;
    for (std::size_t i = s; i < clusters * kBlock; i += kBlock) {
      const Lanes u = scale * *lanes(member + i), move = u - *lanes(present + i);
      const Lanes size = move < 0.0 ? -move : move;
      largest = size > largest ? size : largest;
      *lanes(member + i) = u;
      *lanes(present + i) = u;
    }
  }
  const double a = largest[0] > largest[1] ? largest[0] : largest[1];
  const double b = largest[2] > largest[3] ? largest[2] : largest[3];
  return a > b ? a : b;
}

FPC_TARGET_CLONES
void scaleBlock(const double* points, const double* center, const double* root,
                const double* squared, std::size_t n, double* scaled, double* offset,
                double* sums) {
  Lanes total{}, objective{};
  for (std::size_t s = 0; s < kBlock; s += kLanes) {
    const Lanes weight = *lanes(root + s) * *lanes(root + s);
    total += weight;
    objective += weight * *lanes(squared + s);
  }
  *lanes(sums) += total;
  *lanes(sums + kLanes) += objective;
  for (std::size_t i = 0; i < n; ++i) {
    const double c = center[i];
    Lanes even{}, odd{};
    for (std::size_t s = 0; s < kBlock; s += 2 * kLanes) {
      const double* x = points + i * kBlock + s;
      const Lanes r = *lanes(root + s), q = *lanes(root + s + kLanes);
      const Lanes first = r * (*lanes(x) - c), second = q * (*lanes(x + kLanes) - c);
      *lanes(scaled + i * kBlock + s) = first;
      *lanes(scaled + i * kBlock + s + kLanes) = second;
      even += r * first;
      odd += q * second;
    }
    *lanes(offset + i * kLanes) += even + odd;
  }
}

FPC_TARGET_CLONES
void addScatter(const double* scaled, std::size_t n, double* scatter) {
  const std::size_t rows = padded(n), stride = rows * kLanes;
  for (std::size_t i = 0; i < n; i += kTile) {
    const bool narrow = shortTile(n, i);  // two rows by four columns
    const std::size_t end = i + kTile, step = narrow ? 4 : 2;
    for (std::size_t j = 0; j < end; j += step) {
      const double* x = scaled + (narrow ? j : i) * kBlock;
      const double* y = scaled + (narrow ? i : j) * kBlock;
      Lanes a0{}, b0{}, c0{}, d0{}, a1{}, b1{}, c1{}, d1{};
      for (std::size_t s = 0; s < kBlock; s += kLanes) {
        const Lanes y0 = *lanes(y + s), y1 = *lanes(y + kBlock + s);
        const Lanes a = *lanes(x + s), b = *lanes(x + kBlock + s);
        const Lanes c = *lanes(x + 2 * kBlock + s), d = *lanes(x + 3 * kBlock + s);
        a0 += a * y0;
        a1 += a * y1;
        b0 += b * y0;
        b1 += b * y1;
        c0 += c * y0;
        c1 += c * y1;
        d0 += d * y0;
        d1 += d * y1;
      }
      double* entry = scatter + i * stride + j * kLanes;
      const std::size_t four = narrow ? kLanes : stride, two = narrow ? stride : kLanes;
      *lanes(entry) += a0;
      *lanes(entry + two) += a1;
      *lanes(entry + four) += b0;
      *lanes(entry + four + two) += b1;
      *lanes(entry + 2 * four) += c0;
      *lanes(entry + 2 * four + two) += c1;
      *lanes(entry + 3 * four) += d0;
      *lanes(entry + 3 * four + two) += d1;
    }
  }
}

}  // namespace fpc::clusters
