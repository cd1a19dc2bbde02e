#include "identification/cluster_kernels.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "fmbpc/base/types.hpp"

namespace fpc::clusters {
namespace fuzzy_cluster_kernels_test {

using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Eigen::Index kSamples = kBlock;

Block randomBlock(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Block block(rows, columns);
  for (Eigen::Index i = 0; i < block.size(); ++i) block.data()[i] = normal(generator);
  return block;
}

/// Data of one block of n numbers each, its rows alone in memory so that a sanitizer sees too many.
struct Case {
  explicit Case(Eigen::Index n)
      : points(randomBlock(n, kSamples, 1)),
        center(randomBlock(n, 1, 2)),
        root(randomBlock(1, kSamples, 3).cwiseAbs()),
        squared(randomBlock(1, kSamples, 4).cwiseAbs()),
        away(points.colwise() - center.col(0)) {
    const auto rows = static_cast<Eigen::Index>(padded(static_cast<std::size_t>(n)));
    const Block lower = randomBlock(n, n, 5).triangularView<Eigen::Lower>();
    M = Block::Zero(rows, rows);
    M.topLeftCorner(n, n) = lower;
    scaled = Block::Zero(rows, kSamples);
  }
  Block points, center, root, squared, away, M, scaled;
};

/// Every kind of processor's that this one can run, and numbers that fill tiles and do not.
template <class Check>
void forAll(const Check& check) {
  for (const Kernels& kernels : kernelsHere()) {
    for (Eigen::Index n = 1; n <= 13; ++n) {
      SCOPED_TRACE(kernels.name + std::string(", n ") + std::to_string(n));
      check(kernels, Case(n), static_cast<std::size_t>(n));
    }
  }
}

TEST(ClusterKernels, DistancesAreThoseOfTheMetric) {
  forAll([](const Kernels& kernels, const Case& c, std::size_t n) {
    Block squared = Block::Constant(1, kSamples, -1.0);
    kernels.squaredNorms(c.points.data(), c.center.data(), c.M.data(), n, squared.data());
    const auto rows = c.points.rows();
    const Block expected =
        (c.M.topLeftCorner(rows, rows) * c.away).cwiseAbs2().colwise().sum().eval();
    EXPECT_TRUE(squared.isApprox(expected, 1e-14));

    Block nearest = c.squared;
    kernels.approach(c.points.data(), c.center.data(), n, nearest.data());
    const Block plain = c.away.cwiseAbs2().colwise().sum();
    EXPECT_TRUE(nearest.isApprox(c.squared.cwiseMin(plain), 1e-14));
  });
}

TEST(ClusterKernels, MomentsAreSumsOverTheSamplesAddedToWhatWasThere) {
  forAll([](const Kernels& kernels, Case c, std::size_t n) {
    const auto rows = c.points.rows();
    const std::size_t wide = padded(n);
    std::vector<double> offset(n * kLanes, 0.25), sums(2 * kLanes, 0.25);
    std::vector<double> scatter(wide * wide * kLanes, 0.25);
    kernels.scaleBlock(c.points.data(), c.center.data(), c.root.data(), c.squared.data(), n,
                       c.scaled.data(), offset.data(), sums.data());
    kernels.addScatter(c.scaled.data(), n, scatter.data());

    const Block weight = c.root.cwiseAbs2();
    EXPECT_TRUE(c.scaled.topRows(rows).isApprox(
        (c.away.array().rowwise() * c.root.row(0).array()).matrix(), 1e-15));
    EXPECT_NEAR(lanesSum(sums.data()), 1.0 + weight.sum(), 1e-12);
    EXPECT_NEAR(lanesSum(sums.data() + kLanes), 1.0 + weight.row(0).dot(c.squared.row(0)), 1e-12);
    const Block weighted = c.away.array().rowwise() * weight.row(0).array();
    const Block expected = weighted * c.away.transpose();
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(lanesSum(&offset[i * kLanes]), 1.0 + weighted.row(row).sum(), 1e-11);
      for (std::size_t j = 0; j <= i; ++j)
        EXPECT_NEAR(lanesSum(&scatter[(i * wide + j) * kLanes]),
                    1.0 + expected(row, static_cast<Eigen::Index>(j)), 1e-11);
    }
  });
}

TEST(ClusterKernels, MembershipsAddUpToOneAndTheLargestMoveIsFound) {
  for (const Kernels& kernels : kernelsHere()) {
    SCOPED_TRACE(kernels.name);
    Block squared = randomBlock(3, kSamples, 6).cwiseAbs2();
    squared(1, 17) = 0.0;  // in a centre
    const Block inverse = squared.cwiseInverse();
    Block expected = inverse.array().rowwise() / inverse.colwise().sum().array();
    expected.col(17) << 0.0, 1.0, 0.0;
    Block member(3, kSamples), present = expected;
    present(2, 63) += 0.125;
    EXPECT_NEAR(kernels.shareOut(squared.data(), 3, member.data(), present.data()), 0.125, 1e-14);
    EXPECT_TRUE(member.isApprox(expected, 1e-14));
    EXPECT_EQ(present, member);
  }
}

}  // namespace fuzzy_cluster_kernels_test
}  // namespace fpc::clusters
