#include "identification/cluster_pass.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "identification/cluster_kernels.hpp"

namespace fpc::clusters {
namespace {

using Eigen::Index;

constexpr Index kWidth = static_cast<Index>(kBlock);
constexpr Index kChunk = 64 * kWidth;  // samples that one thread takes at a time

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

using Row = Eigen::Map<Eigen::Array<double, 1, kWidth>, Eigen::Aligned64>;

Row rowOf(Buffer& buffer, Index i) { return Row(buffer.data() + i * kWidth); }

Index blocksOf(Index samples) { return (samples + kWidth - 1) / kWidth; }

}  // namespace

template <class Work>
void Pass::overChunks(const Work& work) {
  parallelFor(chunks_.size(), threads_, [&](std::size_t i) { work(chunks_[i]); });
}

Pass::Pass(MatrixRef points, Index clusters, double fuzziness, int threads)
    : rows_(points.rows()),
      samples_(points.cols()),
      clusters_(clusters),
      fuzziness_(fuzziness),
      threads_(threads) {
  const std::size_t rows = padded(at(rows_)), c = at(clusters);
  centers_.assign(rows * c, 0.0);
  roots_.assign(rows * rows * c, 0.0);
  chunks_.resize(at((samples_ + kChunk - 1) / kChunk));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    chunks_[i].from = static_cast<Index>(i) * kChunk;
    chunks_[i].size = std::min(kChunk, samples_ - chunks_[i].from);
  }
  overChunks([&](Chunk& chunk) { load(points, chunk); });
  restart();
  moments_.weight.setZero(clusters);
  moments_.offset.setZero(rows_, clusters);
  moments_.scatter.assign(c, Matrix::Zero(rows_, rows_));
}

/// The samples of a block side by side; behind the last one, copies of it that weigh nothing.
void Pass::load(MatrixRef points, Chunk& chunk) const {
  const Index blocks = blocksOf(chunk.size);
  chunk.present.assign(at(blocks * clusters_ * kWidth), 0.0);
  chunk.points.resize(at(blocks * rows_ * kWidth));
  double* to = chunk.points.data();
  for (Index block = 0; block < blocks; ++block, to += rows_ * kWidth) {
    for (Index s = 0; s < kWidth; ++s) {
      const Index k = std::min(block * kWidth + s, chunk.size - 1);
      const double* point = points.col(chunk.from + k).data();
      for (Index j = 0; j < rows_; ++j) to[j * kWidth + s] = point[j];
    }
  }
}

void Pass::takeRoom(Chunk& chunk) const {
  const std::size_t rows = padded(at(rows_)), c = at(clusters_);
  chunk.scaled.assign(rows * kBlock, 0.0);
  chunk.squared.assign(c * kBlock, 0.0);
  chunk.member.assign(c * kBlock, 0.0);
  chunk.scatter.assign(rows * rows * c * kLanes, 0.0);
  chunk.offset.assign(rows * c * kLanes, 0.0);
  chunk.sums.assign(2 * c * kLanes, 0.0);
}

/// Of the partial sums only the sums are kept.
void Pass::giveBack(Chunk& chunk) const {
  for (Buffer* buffer : {&chunk.scaled, &chunk.squared, &chunk.member}) Buffer().swap(*buffer);
  for (Buffer* buffer : {&chunk.scatter, &chunk.offset, &chunk.sums}) {
    Buffer kept(buffer->size() / kLanes);
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = lanesSum(buffer->data() + i * kLanes);
    kept.swap(*buffer);
  }
}

void Pass::scatterChunk(const double* center, Chunk& chunk) const {
  const std::size_t n = at(rows_);
  takeRoom(chunk);
  const double* points = chunk.points.data();
  for (Index from = 0; from < chunk.size; from += kWidth, points += rows_ * kWidth) {
    const Index size = std::min(kWidth, chunk.size - from);
    Row weight = rowOf(chunk.member, 0);
    weight.setOnes();
    weight.tail(kWidth - size).setZero();
    kernels().scaleBlock(points, center, weight.data(), chunk.squared.data(), n,
                         chunk.scaled.data(), chunk.offset.data(), chunk.sums.data());
    kernels().addScatter(chunk.scaled.data(), n, chunk.scatter.data());
  }
  giveBack(chunk);
}

Matrix Pass::scatterAround(const Vector& center) {
  overChunks([&](Chunk& chunk) { scatterChunk(center.data(), chunk); });
  const auto rows = static_cast<Index>(padded(at(rows_)));
  Matrix sum = Matrix::Zero(rows_, rows_);
  for (const Chunk& chunk : chunks_) {
    for (Index j = 0; j < rows_; ++j) {
      for (Index k = 0; k <= j; ++k) sum(j, k) += chunk.scatter[at(j * rows + k)];
    }
  }
  sum.triangularView<Eigen::StrictlyUpper>() = sum.transpose();
  return sum;
}

void Pass::restart() {
  overChunks([&](Chunk& chunk) {
    chunk.nearest.assign(at(blocksOf(chunk.size) * kWidth), 0.0);
    std::fill_n(chunk.nearest.begin(), chunk.size, std::numeric_limits<double>::infinity());
  });
}

void Pass::approachIn(const double* center, Chunk& chunk) const {
  double sum[kLanes] = {};
  for (Index block = 0; block < blocksOf(chunk.size); ++block) {
    double* nearest = chunk.nearest.data() + block * kWidth;
    kernels().approach(chunk.points.data() + block * rows_ * kWidth, center, at(rows_), nearest);
    for (std::size_t s = 0; s < kBlock; ++s) sum[s % kLanes] += nearest[s];
  }
  chunk.nearest_sum = lanesSum(sum);
}

double Pass::approach(const Vector& point) {
  overChunks([&](Chunk& chunk) { approachIn(point.data(), chunk); });
  double sum = 0.0;
  for (const Chunk& chunk : chunks_) sum += chunk.nearest_sum;
  return sum;
}

Index Pass::sampleAt(double distance_sum) const {
  double left = distance_sum;
  std::size_t i = 0;
  for (; i + 1 < chunks_.size() && left - chunks_[i].nearest_sum > 0.0; ++i)
    left -= chunks_[i].nearest_sum;
  const auto distance = [&](Index k) { return chunks_[at(k / kChunk)].nearest[at(k % kChunk)]; };
  Index k = chunks_[i].from;
  while (k + 1 < samples_ && (left -= distance(k)) > 0.0) ++k;
  return k;
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
    } else {
      member = (member > 0.0).select((exponent * member.log()).exp(), 0.0).eval();
    }
    sum += member;
  }
  sum = sum.inverse().eval();
  for (Index i = 0; i < clusters_; ++i) rowOf(chunk.member, i) *= sum;
}

/// sqrt(u^m), into `member`
void Pass::toRoots(Chunk& chunk) const {
  for (Index i = 0; i < clusters_; ++i) {
    Row root = rowOf(chunk.member, i);
    if (fuzziness_ == 1.5) {
      root = (root * root.sqrt()).sqrt().eval();
    } else if (fuzziness_ != 2.0) {
      root = (root > 0.0).select((0.5 * fuzziness_ * root.log()).exp(), 0.0).eval();
    }
  }
}

/// Keeps the memberships of a block and how far they moved.
void Pass::store(double* present, Chunk& chunk) const {
  for (Index i = 0; i < clusters_; ++i) {
    Row old(present + i * kWidth);
    const Row fresh = rowOf(chunk.member, i);
    chunk.change = std::max(chunk.change, (fresh - old).abs().maxCoeff());
    old = fresh;
  }
}

void Pass::copyMemberships(Matrix& memberships) const {
  memberships.resize(clusters_, samples_);
  parallelFor(chunks_.size(), threads_, [&](std::size_t c) {
    const Chunk& chunk = chunks_[c];
    for (Index k = 0; k < chunk.size; ++k) {
      const double* present = chunk.present.data() + k / kWidth * clusters_ * kWidth + k % kWidth;
      double* to = memberships.data() + (chunk.from + k) * clusters_;
      for (Index i = 0; i < clusters_; ++i) to[i] = present[i * kWidth];
    }
  });
}

void Pass::addBlock(const double* points, Index size, Chunk& chunk) const {
  const std::size_t n = at(rows_), rows = padded(n);
  for (std::size_t i = 0; i < at(clusters_); ++i) {
    Row root = rowOf(chunk.member, static_cast<Index>(i));
    if (size < kWidth) root.tail(kWidth - size).setZero();
    kernels().scaleBlock(points, centers_.data() + i * rows, root.data(),
                         chunk.squared.data() + i * kBlock, n, chunk.scaled.data(),
                         chunk.offset.data() + i * rows * kLanes,
                         chunk.sums.data() + 2 * i * kLanes);
    if (scatter_)
      kernels().addScatter(chunk.scaled.data(), n, chunk.scatter.data() + i * rows * rows * kLanes);
  }
}

void Pass::runChunk(Chunk& chunk) const {
  const std::size_t n = at(rows_), rows = padded(n);
  takeRoom(chunk);
  chunk.change = 0.0;
  const double* points = chunk.points.data();
  double* present = chunk.present.data();
  for (Index from = 0; from < chunk.size; from += kWidth) {
    for (std::size_t i = 0; i < at(clusters_); ++i) {
      kernels().squaredNorms(points, centers_.data() + i * rows, roots_.data() + i * rows * rows, n,
                             chunk.squared.data() + i * kBlock);
    }
    if (fuzziness_ == 2.0) {
      chunk.change = std::max(chunk.change, kernels().shareOut(chunk.squared.data(), at(clusters_),
                                                               chunk.member.data(), present));
    } else {
      toMemberships(chunk);
      store(present, chunk);
      toRoots(chunk);
    }
    addBlock(points, std::min(kWidth, chunk.size - from), chunk);
    points += rows_ * kWidth;
    present += clusters_ * kWidth;
  }
  giveBack(chunk);
  chunk.objective = 0.0;
  for (std::size_t i = 0; i < at(clusters_); ++i) chunk.objective += chunk.sums[2 * i + 1];
}

void Pass::prepare(const Metric& metric) {
  const Index n = rows_;
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
  const Index n = rows_;
  const auto rows = static_cast<Index>(padded(at(n)));
  moments_.objective = moments_.change = 0.0;
  moments_.weight.setZero();
  moments_.offset.setZero();
  for (Matrix& scatter : moments_.scatter) scatter.setZero();
  for (const Chunk& chunk : chunks_) {
    moments_.objective += chunk.objective;
    moments_.change = std::max(moments_.change, chunk.change);
    for (Index i = 0; i < clusters_; ++i) {
      moments_.weight(i) += chunk.sums[at(2 * i)];
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
  overChunks([&](Chunk& chunk) { runChunk(chunk); });
  collect();
  return moments_;
}

}  // namespace fpc::clusters
