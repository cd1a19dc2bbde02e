// What every plant promises; a new plant is tested here by being registered.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmbpc/plant/plant.hpp"
#include "runtime/contract.hpp"

namespace fpc {
namespace plant_plant_contract_test {

class PlantContract : public ::testing::TestWithParam<std::string> {};

TEST_P(PlantContract, KeepsWhatEveryPlantPromises) {
  const auto plant = makePlant(GetParam());
  for (const Promise& promise : plantPromises(*plant, GetParam()))
    EXPECT_EQ(promise.broken, "") << promise.name;
  for (const auto& name : plant->description().outputs)
    EXPECT_EQ(plant->description().output_frames.count(name), 1U) << name << " has no analyser";
}

INSTANTIATE_TEST_SUITE_P(AllPlants, PlantContract, ::testing::ValuesIn(plantNames()),
                         [](const auto& instance) { return instance.param; });

/// dx/dt = u - x, with mistakes that a test puts into it.
class Mistaken final : public Plant {
 public:
  Mistaken() {
    about.name = "mistaken";
    about.title = "a test";
    about.states = {{"x", "-", 1.0, 0.0, 2.0}};
    about.algebraic = {{"y", "-", 1.0, 0.0, 2.0}};
    about.inputs = {{"u", "-", 1.0, 0.0, 2.0}};
    about.outputs = {"x", "y"};
  }
  const PlantDescription& description() const override { return about; }
  void derivatives(VectorRef x, VectorRef u, VectorRef, Eigen::Ref<Vector> dxdt) const override {
    dxdt[0] = x[0] > limit ? std::nan("") : u[0] - x[0];
  }
  void algebraic(VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> y) const override {
    y[0] = x[0] < from ? std::nan("") : x[0];
  }
  PlantDescription about;
  double limit{10.0}, from{-1.0};
};

/// The promises that are broken, by their number.
std::string brokenOf(const Plant& plant) {
  std::string broken;
  int i = 0;
  for (const Promise& promise : plantPromises(plant, "mistaken")) {
    ++i;
    if (!promise.broken.empty()) broken += std::to_string(i);
  }
  return broken;
}

TEST(PlantPromises, EachMistakeBreaksItsOwn) {
  Mistaken plant;
  EXPECT_EQ(brokenOf(plant), "");
  plant.about.states[0].unit = "";
  EXPECT_EQ(brokenOf(plant), "1");
  plant = Mistaken();
  plant.about.inputs[0].nominal = 1.5;
  EXPECT_EQ(brokenOf(plant), "5");
  plant = Mistaken();
  plant.about.algebraic[0].upper = -1.0;
  EXPECT_EQ(brokenOf(plant), "2");
  plant = Mistaken();
  plant.about.outputs = {"z"};
  EXPECT_EQ(brokenOf(plant), "3");
  plant = Mistaken();
  plant.limit = 1.9;
  EXPECT_EQ(brokenOf(plant), "4");
  plant = Mistaken();
  plant.from = 0.1;
  EXPECT_EQ(brokenOf(plant), "4");
}

}  // namespace plant_plant_contract_test
}  // namespace fpc
