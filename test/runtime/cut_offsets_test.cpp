#include "runtime/cut_offsets.hpp"

#include <algorithm>

#include "config/disturbance_source.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_cut_offsets_test {

/// Of the heated tank, whose T_in is 15 degC and may be 0..40.
class CutOffsetsOfTheTank : public ::testing::Test {
 protected:
  CutOffsetsOfTheTank() : loop_(readLoop("heated_tank")), cut_(disturbancesOf(loop_)) {}
  std::string look(std::uint32_t step, std::vector<Command> commands = {}, bool final = false) {
    std::vector<CommandEffect> effects;
    for (Command& command : commands) effects.push_back({{}, std::move(command)});
    Measurement now;
    now.header.step = step;
    now.final = final;
    cut_.look(now, effects, scheduled_);
    return cut_.lines();
  }
  static Command offset(double value) {
    Command command;
    command.name = {"T_in"};
    command.value = {value};
    command.mode = CommandMode::kOffset;
    return command;
  }
  static Command release() {
    Command command;
    command.name = {"T_in"};
    command.mode = CommandMode::kRelease;
    return command;
  }

  LoopFile loop_;
  Vector scheduled_ = loop_.simulation.disturbance_nominal;
  CutOffsets cut_;
};

TEST_F(CutOffsetsOfTheTank, IsSaidFromTheSampleOnAtWhichItActsUntilItIsReleased) {
  const auto all = disturbancesOf(loop_);
  const auto t_in =
      std::find_if(all.begin(), all.end(), [](const Quantity& q) { return q.name == "T_in"; });
  ASSERT_NE(t_in, all.end());
  const auto row = static_cast<Eigen::Index>(t_in - all.begin());
  const double nominal = loop_.simulation.disturbance_nominal[row];
  const double room = nominal - t_in->lower;
  EXPECT_EQ(look(0), "");
  EXPECT_EQ(look(1, {offset(-room)}), "");  // just on the bound is no slip
  expectWords(look(2, {offset(-room - 0.5)}),
              {"an offset of T_in was asked beyond its range, ", "and clamped"});
  EXPECT_NE(look(3), "");
  EXPECT_EQ(look(4, {release()}), "");
  EXPECT_NE(look(5, {offset(t_in->upper - nominal + 0.5)}), "");
  EXPECT_EQ(look(6, {}, true), "");  // nothing acts on the final sample
  EXPECT_EQ(cut_.samples(), 3U);
  EXPECT_NE(look(7), "");
  EXPECT_EQ(look(0), "");  // a reset
}

TEST_F(CutOffsetsOfTheTank, GoByWhatIsScheduledAtTheSample) {
  EXPECT_EQ(look(1, {offset(10.0)}), "");
  scheduled_.setConstant(31.0);
  EXPECT_NE(look(2), "");
  scheduled_.setConstant(30.0);
  EXPECT_EQ(look(3), "");
}

TEST_F(CutOffsetsOfTheTank, AnOverrideTakesThePlaceOfAnOffset) {
  EXPECT_NE(look(1, {offset(-1000.0)}), "");
  Command command = offset(20.0);
  command.mode = CommandMode::kOverride;
  EXPECT_EQ(look(2, {command}), "");
}

}  // namespace loop_cut_offsets_test
}  // namespace fpc
