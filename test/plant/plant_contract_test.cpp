// What every plant promises; a new plant is tested here by being registered.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "analysis/steady_state.hpp"
#include "fmbpc/plant/plant.hpp"
#include "plant/integrator.hpp"

namespace fpc {
namespace plant_plant_contract_test {

Vector nominal(const std::vector<Quantity>& quantities) {
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = quantities[i].nominal;
  return values;
}

/// Anywhere in the ranges, corners included.
Vector drawn(const std::vector<Quantity>& quantities, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> part(-0.2, 1.2);
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Quantity& q = quantities[i];
    values[static_cast<Eigen::Index>(i)] =
        q.lower + std::clamp(part(generator), 0.0, 1.0) * (q.upper - q.lower);
  }
  return values;
}

class PlantContract : public ::testing::TestWithParam<std::string> {
 protected:
  const std::unique_ptr<Plant> plant = makePlant(GetParam());
  const PlantDescription& about = plant->description();
  const Vector x = nominal(about.states), u = nominal(about.inputs),
               d = nominal(about.disturbances);
};

TEST_P(PlantContract, NamesAreUniqueAndUnitsAreGiven) {
  std::set<std::string> seen;
  for (const auto* group : {&about.states, &about.inputs, &about.disturbances, &about.parameters})
    for (const auto& q : *group) {
      EXPECT_FALSE(q.name.empty());
      EXPECT_FALSE(q.unit.empty()) << q.name;
      EXPECT_TRUE(seen.insert(q.name).second) << q.name << " is there twice";
    }
  EXPECT_EQ(about.name, GetParam());
  EXPECT_FALSE(about.title.empty());
  EXPECT_GT(about.time_unit_s, 0.0);
}

TEST_P(PlantContract, NominalValuesLieInsideTheirRanges) {
  for (const auto* group : {&about.states, &about.inputs, &about.disturbances, &about.parameters})
    for (const auto& q : *group)
      EXPECT_TRUE(q.lower < q.upper && q.nominal >= q.lower && q.nominal <= q.upper) << q.name;
}

TEST_P(PlantContract, OutputsAreStatesAndTheirAnalysersHaveFrames) {
  std::set<std::string> states, frames;
  for (const auto& q : about.states) states.insert(q.name);
  ASSERT_FALSE(about.outputs.empty());
  for (const auto& name : about.outputs) {
    EXPECT_EQ(states.count(name), 1U) << name;
    EXPECT_EQ(about.output_frames.count(name), 1U) << name;
  }
  ASSERT_FALSE(about.frames.empty());
  for (const auto& frame : about.frames) {
    const bool first = frames.empty();
    EXPECT_TRUE(first || frames.count(frame.parent)) << frame.name << " has no parent before it";
    EXPECT_TRUE(frames.insert(frame.name).second) << frame.name << " is there twice";
  }
  for (const auto& entry : about.output_frames) {
    EXPECT_EQ(states.count(entry.first), 1U) << entry.first;
    EXPECT_EQ(frames.count(entry.second), 1U) << entry.second;
  }
}

TEST_P(PlantContract, DerivativesAreFiniteInsideTheRanges) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  Vector dxdt(x.size());
  for (int i = 0; i < 2000; ++i) {
    const Vector state = drawn(about.states, generator), input = drawn(about.inputs, generator);
    const Vector disturbance = drawn(about.disturbances, generator);
    plant->derivatives(state, input, disturbance, dxdt);
    ASSERT_TRUE(dxdt.allFinite()) << state.transpose() << " | " << input.transpose() << " | "
                                  << disturbance.transpose();
  }
}

TEST_P(PlantContract, TheNominalPointIsASteadyState) {
  const auto f = [&](VectorRef state, VectorRef input, VectorRef disturbance,
                     Eigen::Ref<Vector> dxdt) {
    plant->derivatives(state, input, disturbance, dxdt);
  };
  const SteadyState rest = findSteadyState(f, x, u, d);
  ASSERT_TRUE(rest.ok());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    EXPECT_NEAR(rest.x[i], x[i], 1e-4 * (1.0 + std::abs(x[i])))
        << about.states[static_cast<std::size_t>(i)].name;
}

TEST_P(PlantContract, SplittingTheHoldChangesNothing) {
  constexpr unsigned kSeed = 6;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> near(0.8, 1.2);
  Integrator cvode(*plant, {});
  const int trials = x.size() > 50 ? 3 : 50;  // a large plant takes its time
  for (int i = 0; i < trials; ++i) {
    const auto around = [&](const Vector& v) {
      return Vector(v.unaryExpr([&](double a) { return a * near(generator); }));
    };
    const Vector start = around(x), input = around(u), disturbance = around(d);
    const double hold_s = std::min(0.2 * about.time_unit_s, 720.0);
    Vector once = start, half = start;
    ASSERT_TRUE(cvode.advance(once, input, disturbance, hold_s).ok());
    ASSERT_TRUE(cvode.advance(half, input, disturbance, 0.5 * hold_s).ok());
    ASSERT_TRUE(cvode.advance(half, input, disturbance, 0.5 * hold_s).ok());
    EXPECT_LT((once - half).norm(), 1e-6 * (1.0 + once.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(AllPlants, PlantContract, ::testing::ValuesIn(plantNames()),
                         [](const auto& instance) { return instance.param; });

}  // namespace plant_plant_contract_test
}  // namespace fpc
