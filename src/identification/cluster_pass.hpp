// Private: one pass over the data of a fuzzy clustering. It measures distances, moves memberships
// and sums up the moments from which the next centres and shapes follow, in chunks of samples that
// do not depend on the number of threads: same data, same bits.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc::clusters {

/// Doubles on whole cache lines, so that no load of the kernels crosses two.
template <class Number>
struct LineAllocator {
  using value_type = Number;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class Other>
  LineAllocator(const LineAllocator<Other>& /*other*/) {}
  Number* allocate(std::size_t n) {
    return static_cast<Number*>(::operator new(n * sizeof(Number), kLine));
  }
  void deallocate(Number* p, std::size_t /*n*/) { ::operator delete(p, kLine); }
  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
  friend bool operator!=(const LineAllocator&, const LineAllocator&) { return false; }
};
using Buffer = std::vector<double, LineAllocator<double>>;

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
  /// Copies `points` (n samples) into blocks. @param threads 0: all cores
  Pass(MatrixRef points, Eigen::Index clusters, double fuzziness, int threads);
  /// sum (z - center)(z - center)' of all samples.
  Matrix scatterAround(const Vector& center);
  /// Takes another point into account. @return the sum over samples of the squared distance to the
  /// nearest of the points since restart()
  double approach(const Vector& point);
  /// The sample at which the squared distances to the nearest point add up to that.
  Eigen::Index sampleAt(double distance_sum) const;
  void restart();  ///< forgets the points of approach()
  /// Moves the memberships and sums up; without `scatter` the moments have none.
  const Moments& run(const Metric& metric, bool scatter);
  void copyMemberships(Matrix& memberships) const;  ///< c samples

 private:
  struct Chunk {
    Eigen::Index from{}, size{};
    Buffer points, present;  // and memberships, block by block
    Buffer nearest;          // squared distance to the nearest point of approach()
    Buffer scaled, squared, member;
    Buffer scatter, offset, sums;  // of all clusters, padded, partial sums
    double objective{}, change{}, nearest_sum{};
  };

  void load(MatrixRef points, Chunk& chunk) const;
  void takeRoom(Chunk& chunk) const;
  void giveBack(Chunk& chunk) const;
  void runChunk(Chunk& chunk) const;
  void scatterChunk(const double* center, Chunk& chunk) const;
  void approachIn(const double* center, Chunk& chunk) const;
  void toMemberships(Chunk& chunk) const;
  void toRoots(Chunk& chunk) const;
  void store(double* present, Chunk& chunk) const;
  void addBlock(const double* points, Eigen::Index size, Chunk& chunk) const;
  void prepare(const Metric& metric);
  void collect();
  template <class Work>
  void overChunks(const Work& work);

  Eigen::Index rows_, samples_, clusters_;
  double fuzziness_;
  int threads_;
  bool scatter_{};
  Buffer centers_, roots_;  // padded
  std::vector<Chunk> chunks_;
  Moments moments_;
};

}  // namespace fpc::clusters
