// Which signals a law needs, and which it steers, by type: what plausibility and guard ask.
#include <gtest/gtest.h>

#include "config/loop_file.hpp"

namespace fpc {
namespace config_signal_use_test {

struct Use {
  std::vector<bool> needs;  // outputs, then measured disturbances
  std::vector<Eigen::Index> followed;
  bool operator==(const Use& other) const {
    return needs == other.needs && followed == other.followed;
  }
};

std::ostream& operator<<(std::ostream& stream, const Use& use) {
  for (const bool need : use.needs) stream << need;
  stream << " of";
  for (const Eigen::Index output : use.followed) stream << " " << output;
  return stream;
}

Use useOf(const std::string& name, const Overrides& overrides = {}) {
  const LoopFile loop = readLoop(name, overrides);
  return {loop.plausibility.needs, loop.guard.lock_outputs};
}

// Outputs s, x; disturbances q_i, s_i.
TEST(SignalUse, APiNeedsItsOutputAndWhatItFeedsForward) {
  EXPECT_EQ(useOf("asp_case1_pi_x"), (Use{{false, true, false, false}, {1}}));
  EXPECT_EQ(useOf("asp_case1_pi_s"), (Use{{true, false, false, false}, {0}}));
  EXPECT_EQ(useOf("asp_case1_pi_x_best"), (Use{{false, true, true, true}, {1}}));
}

TEST(SignalUse, APredictiveLawNeedsAllAndFollowsWhatHasAWeight) {
  const std::vector<bool> all(4, true);
  EXPECT_EQ(useOf("asp_case1"), (Use{all, {1}})) << "published: the last output";
  EXPECT_EQ(useOf("asp_case1_general"), (Use{all, {1}}));
  EXPECT_EQ(useOf("asp_case1_general", {{"controller.weight_output.s", "1"}}), (Use{all, {0, 1}}));
  EXPECT_EQ(useOf("linear_2x2"), (Use{{true, true}, {0, 1}}));
  EXPECT_EQ(useOf("linear_2x2", {{"controller.weight_output", "{y1: 0, y2: 1}"}}),
            (Use{{true, true}, {1}}));
}

TEST(SignalUse, OfWhatOnlySomeIsNeededTheRestMayFail) {
  EXPECT_EQ(useOf("column_adaptive", {{"plant.measured_disturbances", "[F]"}}),
            (Use{{true, true, false}, {0, 1}}))
      << "not the feed";
  const Overrides constant{{"disturbance", "{}"}, {"plant.outputs", "[S_NO5, S_NH5]"}};
  EXPECT_EQ(useOf("bsm1_supervisor", constant), (Use{{false, true, true, true}, {1}}));
}

}  // namespace config_signal_use_test
}  // namespace fpc
