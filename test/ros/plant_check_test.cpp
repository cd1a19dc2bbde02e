#include "ros/plant_check.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fpc {
namespace ros_plant_check_test {

PlantInfo tank() {
  PlantInfo info;
  info.name = "tank";
  info.sample_time_s = 60.0;
  info.outputs = {{"level", "m", 0.0, 4.0}};
  info.inputs = {{"inflow", "m3/h", 0.0, 20.0}};
  return info;
}

TEST(PlantCheck, AcceptsTheSamePlantWithOtherBounds) {
  PlantInfo arrived = tank();
  arrived.outputs[0].upper = 5.0;
  arrived.name = "another tank";
  EXPECT_EQ("", plantMismatch(tank(), arrived));
  EXPECT_EQ("plant_info: level may be 0..5, the loop file says 0..4",
            boundsDifference(tank(), arrived));
  EXPECT_EQ("", boundsDifference(tank(), tank()));
}

TEST(PlantCheck, BoundsThatTheLoopFileLeavesOpenAreNotCompared) {
  PlantInfo open = tank();
  open.inputs[0].upper = std::numeric_limits<double>::infinity();
  EXPECT_EQ("", boundsDifference(open, tank()));
}

TEST(PlantCheck, NamesTheFirstDifference) {
  PlantInfo arrived = tank();
  arrived.sample_time_s = 30.0;
  EXPECT_EQ("plant_info: the sample time is 30 s, the loop file expects 60 s",
            plantMismatch(tank(), arrived));
  arrived = tank();
  arrived.outputs[0].unit = "cm";
  EXPECT_EQ("plant_info: outputs are level[cm], the loop file expects level[m]",
            plantMismatch(tank(), arrived));
  arrived = tank();
  arrived.inputs.clear();
  EXPECT_EQ("plant_info: inputs are none, the loop file expects inflow[m3/h]",
            plantMismatch(tank(), arrived));
  arrived = tank();
  arrived.disturbances = {{"rain", "mm/h", 0.0, 50.0}};
  EXPECT_EQ("plant_info: measured disturbances are rain[mm/h], the loop file expects none",
            plantMismatch(tank(), arrived));
}

}  // namespace ros_plant_check_test
}  // namespace fpc
