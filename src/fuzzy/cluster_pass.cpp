#include "fuzzy/cluster_pass.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/parallel.hpp"
#include "fuzzy/cluster_kernels.hpp"

namespace fpc::clusters {
namespace {

using Eigen::Index;

constexpr Index kChunk =
    32 * static_cast<Index>(kBlock);  // samples that one thread takes at a time
constexpr Index kWidth = static_cast<Index>(kBlock);

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

using Row = Eigen::Map<Eigen::Array<double, 1, kWidth>, Eigen::Aligned16>;

Row rowOf(Buffer& buffer, Index i) { return Row(buffer.data() + i * kWidth); }

}  // namespace

Pass::Pass(MatrixRef points, Index clusters, double fuzziness, int threads)
    : points_(points), clusters_(clusters), fuzziness_(fuzziness), threads_(threads) {
  const Index n = points.rows(), samples = points.cols();
  const std::size_t rows = padded(at(n)), c = at(clusters);
  centers_.assign(rows * c, 0.0);
  roots_.assign(rows * rows * c, 0.0);
  chunks_.resize(at((samples + kChunk - 1) / kChunk));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = chunks_[i];
    chunk.from = static_cast<Index>(i) * kChunk;
    chunk.size = std::min(kChunk, samples - chunk.from);
    chunk.present.assign(at((chunk.size + kWidth - 1) / kWidth) * c * kBlock, 0.0);
    chunk.scatter.assign(rows * rows * c, 0.0);
    chunk.offset.assign(rows * c, 0.0);
    chunk.total.assign(c, 0.0);
  }
  moments_.weight.setZero(clusters);
  moments_.offset.setZero(n, clusters);
  moments_.scatter.assign(c, Matrix::Zero(n, n));
}

/// The samples of a block side by side; behind the last one, copies of it that weigh nothing.
void Pass::loadBlock(Index from, Index size, Chunk& chunk) const {
  const Index n = points_.rows();
  for (Index s = 0; s < kWidth; ++s) {
    const double* point = points_.col(from + std::min(s, size - 1)).data();
    for (Index j = 0; j < n; ++j) chunk.points[at(j * kWidth + s)] = point[j];
  }
}

void Pass::moveFrom(Index cluster, Chunk& chunk) const {
  const std::size_t n = at(points_.rows());
  subtract(chunk.points.data(), centers_.data() + at(cluster) * padded(n), n, chunk.away.data());
}

/// Squared distances into memberships; a point in a centre belongs to it alone.
void Pass::toMemberships(Chunk& chunk) const {
  using Values = Eigen::Array<double, 1, kWidth>;
  const double exponent = 1.0 / (fuzziness_ - 1.0);
  Values nearest = rowOf(chunk.squared, 0), sum = Values::Zero();
  for (Index i = 1; i < clusters_; ++i) nearest = nearest.min(rowOf(chunk.squared, i));
  for (Index i = 0; i < clusters_; ++i) {
    const auto squared = rowOf(chunk.squared, i);
    Row member = rowOf(chunk.member, i);
    member = (squared <= nearest).select(1.0, nearest / squared);
    if (exponent == 2.0) {
      member = member.square().eval();
    } else if (exponent != 1.0) {
      member = (member > 0.0).select((exponent * member.log()).exp(), 0.0).eval();
    }
    sum += member;
  }
  sum = sum.inverse().eval();
  for (Index i = 0; i < clusters_; ++i) rowOf(chunk.member, i) *= sum;
}

/// u^m
void Pass::toWeights(Chunk& chunk) const {
  for (Index i = 0; i < clusters_; ++i) {
    const Row member = rowOf(chunk.member, i);
    Row weight = rowOf(chunk.weight, i);
    if (fuzziness_ == 2.0) {
      weight = member.square();
    } else if (fuzziness_ == 1.5) {
      weight = member * member.sqrt();
    } else {
      weight = (member > 0.0).select((fuzziness_ * member.log()).exp(), 0.0);
    }
  }
}

/// Keeps the memberships of a block and how far they moved.
void Pass::store(Index size, double* present, Chunk& chunk) const {
  for (Index i = 0; i < clusters_; ++i) {
    Row old(present + i * kWidth);
    const Row fresh = rowOf(chunk.member, i);
    chunk.change = std::max(chunk.change, (fresh - old).abs().head(size).maxCoeff());
    old = fresh;
  }
}

void Pass::copyMemberships(Matrix& memberships) const {
  memberships.resize(clusters_, points_.cols());
  for (Index k = 0; k < points_.cols(); ++k) {
    const Chunk& chunk = chunks_[at(k / kChunk)];
    const Index block = k % kChunk / kWidth, s = k % kWidth;
    const double* present = chunk.present.data() + block * clusters_ * kWidth + s;
    for (Index i = 0; i < clusters_; ++i) memberships(i, k) = present[i * kWidth];
  }
}

void Pass::addBlock(Index size, Chunk& chunk) const {
  const std::size_t n = at(points_.rows()), rows = padded(n);
  for (Index i = 0; i < clusters_; ++i) {
    Row weight = rowOf(chunk.weight, i);
    if (size < kWidth) weight.tail(kWidth - size).setZero();
    chunk.total[at(i)] += weight.sum();
    chunk.objective += (weight * rowOf(chunk.squared, i)).sum();
    moveFrom(i, chunk);
    scaleBlock(chunk.away.data(), weight.data(), n, chunk.scaled.data(),
               chunk.offset.data() + at(i) * rows);
    if (scatter_)
      addScatter(chunk.away.data(), chunk.scaled.data(), n,
                 chunk.scatter.data() + at(i) * rows * rows);
  }
}

void Pass::runChunk(Chunk& chunk) const {
  const std::size_t n = at(points_.rows()), rows = padded(n), c = at(clusters_);
  for (Buffer* buffer : {&chunk.points, &chunk.away, &chunk.scaled})
    buffer->assign(rows * kBlock, 0.0);
  for (Buffer* buffer : {&chunk.squared, &chunk.member, &chunk.weight})
    buffer->assign(c * kBlock, 0.0);
  for (Buffer* buffer : {&chunk.scatter, &chunk.offset, &chunk.total})
    std::fill(buffer->begin(), buffer->end(), 0.0);
  chunk.objective = chunk.change = 0.0;
  double* present = chunk.present.data();
  for (Index from = chunk.from; from < chunk.from + chunk.size; from += kWidth) {
    const Index size = std::min(kWidth, chunk.from + chunk.size - from);
    loadBlock(from, size, chunk);
    for (Index i = 0; i < clusters_; ++i) {
      moveFrom(i, chunk);
      squaredNorms(chunk.away.data(), roots_.data() + at(i) * rows * rows, n,
                   chunk.squared.data() + at(i) * kBlock);
    }
    toMemberships(chunk);
    store(size, present, chunk);
    present += clusters_ * kWidth;
    toWeights(chunk);
    addBlock(size, chunk);
  }
  for (Buffer* buffer :
       {&chunk.points, &chunk.away, &chunk.scaled, &chunk.squared, &chunk.member, &chunk.weight})
    Buffer().swap(*buffer);
}

void Pass::prepare(const Metric& metric) {
  const Index n = points_.rows();
  const auto rows = static_cast<Index>(padded(at(n)));
  for (Index i = 0; i < clusters_; ++i) {
    for (Index j = 0; j < n; ++j) {
      centers_[at(i * rows + j)] = metric.centers(j, i);
      for (Index k = 0; k <= j; ++k)
        roots_[at((i * rows + j) * rows + k)] = metric.root[at(i)](j, k);
    }
  }
}

void Pass::collect() {
  const Index n = points_.rows();
  const auto rows = static_cast<Index>(padded(at(n)));
  moments_.objective = moments_.change = 0.0;
  moments_.weight.setZero();
  moments_.offset.setZero();
  for (Matrix& scatter : moments_.scatter) scatter.setZero();
  for (const Chunk& chunk : chunks_) {
    moments_.objective += chunk.objective;
    moments_.change = std::max(moments_.change, chunk.change);
    for (Index i = 0; i < clusters_; ++i) {
      moments_.weight(i) += chunk.total[at(i)];
      for (Index j = 0; j < n; ++j) {
        moments_.offset(j, i) += chunk.offset[at(i * rows + j)];
        for (Index k = 0; k <= j; ++k)
          moments_.scatter[at(i)](j, k) += chunk.scatter[at((i * rows + j) * rows + k)];
      }
    }
  }
  for (Matrix& scatter : moments_.scatter)
    scatter.triangularView<Eigen::StrictlyUpper>() = scatter.transpose();
}

const Moments& Pass::run(const Metric& metric, bool scatter) {
  scatter_ = scatter;
  prepare(metric);
  parallelFor(chunks_.size(), threads_, [&](std::size_t i) { runChunk(chunks_[i]); });
  collect();
  return moments_;
}

}  // namespace fpc::clusters
