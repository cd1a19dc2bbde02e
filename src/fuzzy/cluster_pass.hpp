// Private: one pass over the data of a fuzzy clustering. It measures distances, moves memberships
// and sums up the moments from which the next centres and shapes follow, in chunks of samples that
// do not depend on the number of threads: same data, same bits.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc::clusters {

/// Doubles aligned for the kernels.
using Buffer = std::vector<double, Eigen::aligned_allocator<double>>;

/// Sums over samples for each cluster, away from the centre that the distances were measured from.
struct Moments {
  double objective{};           ///< sum u^m d^2
  double change{};              ///< largest move of a membership
  Vector weight;                ///< c, sum u^m
  Matrix offset;                ///< n c, sum u^m (z - v)
  std::vector<Matrix> scatter;  ///< c of n n, sum u^m (z - v)(z - v)'
};

/// What distances are measured by: |root_i (z - v_i)|^2.
struct Metric {
  Matrix centers;            ///< n c
  std::vector<Matrix> root;  ///< c of n n, lower triangular
};

class Pass {
 public:
  /// `points` n samples, kept by reference. @param threads 0: all cores
  Pass(MatrixRef points, Eigen::Index clusters, double fuzziness, int threads);
  /// Moves the memberships and sums up; without `scatter` the moments have none.
  const Moments& run(const Metric& metric, bool scatter);
  void copyMemberships(Matrix& memberships) const;  ///< c samples

 private:
  struct Chunk {
    Eigen::Index from{}, size{};
    Buffer present;  // memberships, block by block
    Buffer points, away, scaled, squared, member, weight;
    Buffer scatter, offset, total;  // of all clusters, padded
    double objective{}, change{};
  };

  void runChunk(Chunk& chunk) const;
  void loadBlock(Eigen::Index from, Eigen::Index size, Chunk& chunk) const;
  void moveFrom(Eigen::Index cluster, Chunk& chunk) const;
  void toMemberships(Chunk& chunk) const;
  void toWeights(Chunk& chunk) const;
  void store(Eigen::Index size, double* present, Chunk& chunk) const;
  void addBlock(Eigen::Index size, Chunk& chunk) const;
  void prepare(const Metric& metric);
  void collect();

  MatrixRef points_;
  Eigen::Index clusters_;
  double fuzziness_;
  int threads_;
  bool scatter_{};
  Buffer centers_, roots_;  // padded
  std::vector<Chunk> chunks_;
  Moments moments_;
};

}  // namespace fpc::clusters
