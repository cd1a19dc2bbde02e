#include "fmbpc/plant/plant.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "error_words.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace plant_plant_test {

PlantDescription twoParameters() {
  PlantDescription description;
  description.parameters = {{"volume", "m3", 10.0, 1.0, 100.0}, {"gain", "-", 2.0, -5.0, 5.0}};
  return description;
}

std::string errorOf(const PlantParameters& parameters) {
  return test::thrownBy([&] { parameterValues(twoParameters(), parameters); });
}

TEST(Plant, ParametersAreReadOverTheirNominalValues) {
  const Vector values = parameterValues(twoParameters(), {{"gain", -3.0}});
  EXPECT_EQ(values[0], 10.0);
  EXPECT_EQ(values[1], -3.0);
}

TEST(Plant, BadParametersAreNamed) {
  EXPECT_NE(errorOf({{"volum", 1.0}}).find("one of volume, gain"), std::string::npos);
  EXPECT_NE(errorOf({{"volume", 0.0}}).find("plant.parameters.volume"), std::string::npos);
  EXPECT_NE(errorOf({{"volume", 101.0}}).find("<= 100 [m3], got 101"), std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf({{"gain", nan}}).find("plant.parameters.gain"), std::string::npos);
}

TEST(Plant, AnUnknownPlantIsReportedWithTheKnownOnes) {
  try {
    makePlant("no_such_plant");
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("activated_sludge"), std::string::npos) << e.what();
  }
}

TEST(Plant, ANameIsRegisteredOnce) {
  EXPECT_FALSE(registerPlant("activated_sludge", [](const PlantParameters&) { return nullptr; }));
  EXPECT_NE(makePlant("activated_sludge"), nullptr);
}

}  // namespace plant_plant_test
}  // namespace fpc
