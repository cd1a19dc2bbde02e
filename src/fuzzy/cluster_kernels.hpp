// Private: the arithmetic of fuzzy clustering on blocks of samples, dimension by dimension with the
// samples of a block side by side, so that the compiler's vectors hold samples.
// Shapes: points, away, scaled padded(n) kBlock; M, scatter padded(n) padded(n); all row by
// row, rows beyond n zero.
#pragma once

#include <cstddef>

namespace fpc::clusters {

constexpr std::size_t kBlock = 128;  // samples; a buffer row holds that many
constexpr std::size_t kTile = 4;     // rows are padded with zeros to a multiple of it

inline std::size_t padded(std::size_t rows) { return (rows + kTile - 1) / kTile * kTile; }

/// away(s) = points(s) - center
void subtract(const double* points, const double* center, std::size_t n, double* away);

/// squared(s) = |M away(s)|^2, M lower triangular.
void squaredNorms(const double* away, const double* M, std::size_t n, double* squared);

/// scaled(s) = weight(s) away(s), and sum += sum_s scaled(s).
void scaleBlock(const double* away, const double* weight, std::size_t n, double* scaled,
                double* sum);

/// scatter += sum_s scaled(s) away(s)', the lower triangle.
void addScatter(const double* away, const double* scaled, std::size_t n, double* scatter);

}  // namespace fpc::clusters
