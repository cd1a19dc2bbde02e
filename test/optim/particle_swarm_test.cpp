#include "optim/particle_swarm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace optim_particle_swarm_test {

Vector two(double a, double b) { return (Vector(2) << a, b).finished(); }

double bowl(const Vector& x) { return std::pow(x[0] - 0.3, 2) + 10.0 * std::pow(x[1] + 0.2, 2); }

TEST(ParticleSwarm, FindsTheBottomOfABowlWithBothUsualSettings) {
  SwarmParams falling, constriction;
  constriction.inertia_start = constriction.inertia_end = 0.73;
  constriction.cognitive = constriction.social = 1.496;
  for (SwarmParams params : {falling, constriction}) {
    params.iterations = 100;
    const SwarmResult found = minimizeBySwarm(bowl, two(-1, -1), two(1, 1), params);
    EXPECT_NEAR(found.best[0], 0.3, 1e-3);
    EXPECT_NEAR(found.best[1], -0.2, 1e-3);
    EXPECT_EQ(found.evaluations, 50 * 101);
  }
}

TEST(ParticleSwarm, DoesNotSettleWithThePrintedConstantInertia) {
  const auto spread = [](double inertia_end, std::uint64_t seed) {
    SwarmParams params;
    params.inertia_end = inertia_end;
    params.seed = seed;
    Vector last;  // what the last particle asked for
    minimizeBySwarm([&](const Vector& x) { return bowl(last = x); }, two(-1, -1), two(1, 1),
                    params);
    return (last - two(0.3, -0.2)).norm();
  };
  double printed = 0.0, falling = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    printed += spread(0.9, seed) / 20.0;
    falling += spread(0.4, seed) / 20.0;
  }
  EXPECT_GT(printed, 0.3);
  EXPECT_LT(falling, 0.1);
}

TEST(ParticleSwarm, GivesTheSameAnswerForTheSameSeedAndAnotherForAnother) {
  SwarmParams params;
  params.iterations = 5;
  const auto run = [&] { return minimizeBySwarm(bowl, two(-1, -1), two(1, 1), params).best; };
  const Vector first = run();
  EXPECT_EQ(first, run());
  params.seed = 2;
  EXPECT_NE(first, run());
}

TEST(ParticleSwarm, NeverLeavesTheBox) {
  constexpr unsigned kSeed = 4;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  SwarmParams params;
  params.seed = kSeed;
  params.speed_upper = 1.0;
  const Vector lower = two(-1, 2), upper = two(-0.5, 2);  // one side has no width
  int outside = 0;
  const auto cost = [&](const Vector& x) {
    outside += (x.array() < lower.array()).any() || (x.array() > upper.array()).any();
    return -x[0];
  };
  const SwarmResult found = minimizeBySwarm(cost, lower, upper, params);
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(found.best, two(-0.5, 2));
}

TEST(ParticleSwarm, BeginsAtTheStartAndTakesNothingWorse) {
  SwarmParams params;
  params.iterations = 0;
  const SwarmResult found = minimizeBySwarm(bowl, two(-1, -1), two(1, 1), params, two(0.3, -0.2));
  EXPECT_EQ(found.cost, 0.0);
  EXPECT_EQ(found.best, two(0.3, -0.2));
}

TEST(ParticleSwarm, StopsWhenTheCallbackSaysSo) {
  SwarmParams params;
  int calls = 0;
  const SwarmResult found =
      minimizeBySwarm(bowl, two(-1, -1), two(1, 1), params, {}, [&](int iteration, const auto&) {
        ++calls;
        return iteration == 3;
      });
  EXPECT_TRUE(found.stopped);
  EXPECT_EQ(calls, 4);
  EXPECT_EQ(found.evaluations, 50 * 4);
}

TEST(ParticleSwarm, TakesNaNForInfinite) {
  const auto cost = [](const Vector& x) { return x[0] > 0.0 ? std::nan("") : -x[0]; };
  const SwarmResult found = minimizeBySwarm(cost, two(-1, 0), two(1, 1), {});
  EXPECT_LE(found.best[0], 0.0);
  const SwarmResult none =
      minimizeBySwarm([](const Vector&) { return std::nan(""); }, two(-1, 0), two(1, 1), {});
  EXPECT_EQ(none.cost, std::numeric_limits<double>::infinity());
}

TEST(ParticleSwarm, RefusesWhatIsNoBox) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THROW(minimizeBySwarm(bowl, two(0, 0), Vector::Zero(1), {}), InputError);
  EXPECT_THROW(minimizeBySwarm(bowl, two(0, 0), two(1, -1), {}), InputError);
  EXPECT_THROW(minimizeBySwarm(bowl, two(0, 0), two(1, infinite), {}), InputError);
  SwarmParams params;
  params.particles = 0;
  EXPECT_THROW(minimizeBySwarm(bowl, two(0, 0), two(1, 1), params), InputError);
}

}  // namespace optim_particle_swarm_test
}  // namespace fpc
