// The table of settings as dynamic_reconfigure's messages, and back.
#include "ros/settings_server.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace ros_settings_server_test {

const std::vector<SettingInfo> kTable = {
    {"gain", SettingKind::kNumber, "a number", 0.0, 10.0},
    {"steps", SettingKind::kInteger, "an integer", 1, 100},
    {"preview", SettingKind::kBoolean, "yes or no"},
    {"weight", SettingKind::kText, "by name"},
};
const Settings kSettings = {
    {"gain", "2.5"}, {"steps", "7"}, {"preview", "true"}, {"weight", "a=1 b=2"}};

TEST(SettingsServer, EveryKindTravelsThereAndBack) {
  const dynamic_reconfigure::Config config = settingsMessage(kTable, kSettings);
  ASSERT_EQ(config.doubles.size(), 1U);
  EXPECT_EQ(config.doubles[0].name, "gain");
  EXPECT_EQ(config.doubles[0].value, 2.5);
  ASSERT_EQ(config.ints.size(), 1U);
  EXPECT_EQ(config.ints[0].value, 7);
  ASSERT_EQ(config.bools.size(), 1U);
  EXPECT_TRUE(config.bools[0].value);
  ASSERT_EQ(config.strs.size(), 1U);
  EXPECT_EQ(config.strs[0].value, "a=1 b=2");
  ASSERT_EQ(config.groups.size(), 1U);  // clients look for it
  EXPECT_EQ(settingsOf(kTable, config), kSettings);
}

TEST(SettingsServer, ARequestHoldsOnlyWhatChanges) {
  dynamic_reconfigure::Config config;
  config.ints.resize(1);
  config.ints[0].name = "gain";  // typed as an integer by the person
  config.ints[0].value = 3;
  EXPECT_EQ(settingsOf(kTable, config), (Settings{{"gain", "3"}}));
  config.ints[0].name = "unknown";
  EXPECT_TRUE(settingsOf(kTable, config).empty());
}

TEST(SettingsServer, NumbersOutsideTheTablesRangeAreRefused) {
  dynamic_reconfigure::Config config;
  config.doubles.resize(1);
  config.doubles[0].name = "gain";
  for (const double value : {-0.1, 10.1, std::nan("")}) {
    config.doubles[0].value = value;
    EXPECT_THROW(settingsOf(kTable, config), InputError) << value;
  }
}

}  // namespace ros_settings_server_test
}  // namespace fpc
