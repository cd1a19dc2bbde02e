// Private: the arithmetic of fuzzy clustering on blocks of samples, dimension by dimension with the
// samples of a block side by side, so that the compiler's vectors hold samples. What is summed over
// samples is kept as kLanes partial sums until lanesSum().
// Shapes: points n kBlock; scaled padded(n) kBlock; M padded(n) padded(n), scatter
// padded(n) padded(n) kLanes, offset padded(n) kLanes; all row by row, rows beyond n zero.
#pragma once

#include <cstddef>
#include <vector>

namespace fpc::clusters {

constexpr std::size_t kBlock = 64;  // samples; what a block needs fits into the first cache
constexpr std::size_t kLanes = 4;   // partial sums
constexpr std::size_t kTile = 4;    // rows are padded with zeros to a multiple of it

inline std::size_t padded(std::size_t rows) { return (rows + kTile - 1) / kTile * kTile; }

/// Sum of the partial sums.
inline double lanesSum(const double* lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// The same arithmetic compiled for one kind of processor.
struct Kernels {
  const char* name;
  /// squared(s) = |M (points(s) - center)|^2, M lower triangular.
  void (*squaredNorms)(const double* points, const double* center, const double* M, std::size_t n,
                       double* squared);
  /// nearest(s) = min(nearest(s), |points(s) - center|^2)
  void (*approach)(const double* points, const double* center, std::size_t n, double* nearest);
  /// Memberships u of fuzziness 2 from squared distances, c kBlock each: member = u = present. A
  /// point in a centre belongs to it alone. @return the largest move |u - present|
  double (*shareOut)(const double* squared, std::size_t clusters, double* member, double* present);
  /// scaled(s) = root(s) (points(s) - center), offset += sum_s root(s) scaled(s); sums[0] += sum_s
  /// root(s)^2 and sums[1] += sum_s root(s)^2 squared(s), kLanes each.
  void (*scaleBlock)(const double* points, const double* center, const double* root,
                     const double* squared, std::size_t n, double* scaled, double* offset,
                     double* sums);
  /// scatter += sum_s scaled(s) scaled(s)', the lower triangle.
  void (*addScatter)(const double* scaled, std::size_t n, double* scatter);
};

/// Those that this processor can run, the fastest last.
std::vector<Kernels> kernelsHere();
/// The fastest of them.
const Kernels& kernels();

}  // namespace fpc::clusters
