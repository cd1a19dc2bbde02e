// Records of a closed loop are told from those of an open one.
#include "identification/feedback_share.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace fpc {
namespace fuzzy_feedback_share_test {

using Eigen::Index;

struct Record {
  Vector u, y;
};

double plant(double y, double u) {
  return 0.85 * y + 0.15 * (u + 0.5 * u * std::abs(u)) * (1.2 - 0.5 * std::tanh(y));
}

/// Inputs that nobody's law makes: held at random for a fixed or random time, white, wandering.
Record openLoop(Index rows, int kind, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Record r{Vector(rows), Vector(rows)};
  double y = 0.0, u = 0.0;
  Index until = 0;
  for (Index k = 0; k < rows; ++k) {
    if (kind == 2) u = standardNormal(random);
    if (kind == 3) u = 0.98 * u + 0.2 * standardNormal(random);
    if (kind < 2 && k >= until) {
      u = 4.0 * uniform(random) - 2.0;
      until = k + (kind == 0 ? 6 : 5 + static_cast<Index>(20.0 * uniform(random)));
    }
    r.u[k] = u;
    r.y[k] = y + 0.02 * standardNormal(random);
    y = plant(y, u);
  }
  return r;
}

/// A PI controller of a linear lag with a disturbance (`shaken`) or without; setpoints in steps.
Record closedLoop(Index rows, double shaken, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Record r{Vector(rows), Vector(rows)};
  double y = 0.0, integral = 0.0, w = 0.0, d = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 60 == 0) w = 2.0 * uniform(random) - 1.0;
    integral += 0.15 * (w - y);
    r.u[k] = 1.2 * (w - y) + integral;
    r.y[k] = y;
    d = 0.95 * d + 0.1 * shaken * standardNormal(random);
    y = 0.85 * y + 0.15 * r.u[k] * (1.2 - 0.5 * std::tanh(y)) + 0.15 * d;
  }
  return r;
}

TEST(Feedback, IsSeenInEveryRecordOfAClosedLoop) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double shaken : {1.0, 0.0}) {
      const Record r = closedLoop(500, shaken, seed);
      EXPECT_GT(feedbackShare(r.u, r.y), 0.02) << "seed " << seed << ", shaken " << shaken;
    }
}

TEST(Feedback, IsSeenInFewerThanOneInTwoHundredOpenRecords) {
  int false_alarms = 0, records = 0;
  for (int kind = 0; kind < 4; ++kind)
    for (std::uint64_t seed = 1; seed <= 60; ++seed, ++records) {
      const Record r = openLoop(300, kind, 1000 * static_cast<std::uint64_t>(kind + 1) + seed);
      if (feedbackShare(r.u, r.y) > 0.0) ++false_alarms;
    }
  EXPECT_LE(false_alarms, records / 200);
}

TEST(Feedback, IsNotSeenInAPeriodicInputThatItsPastTells) {
  Record r = openLoop(400, 2, 5);
  double y = 0.0;
  std::mt19937_64 random(3);
  for (Index k = 0; k < 400; ++k) {
    r.u[k] = 0.0;
    for (int i = 1; i < 10; ++i)
      r.u[k] += std::sin(2.0 * 3.141592653589793 * i * static_cast<double>(k) / 200.0 + i * i);
    r.y[k] = y + 0.02 * standardNormal(random);
    y = plant(y, r.u[k]);
  }
  EXPECT_EQ(feedbackShare(r.u, r.y), 0.0);
}

TEST(Feedback, OfTooShortOrEmptyRecordsIsNotJudged) {
  const Record r = closedLoop(20, 1.0, 1);
  EXPECT_EQ(feedbackShare(r.u, r.y), 0.0);
  const Vector none = Vector::Constant(300, kNaN);
  EXPECT_EQ(feedbackShare(none, none), 0.0);
  EXPECT_EQ(feedbackShare(Vector(), Vector()), 0.0);
}

}  // namespace fuzzy_feedback_share_test
}  // namespace fpc
