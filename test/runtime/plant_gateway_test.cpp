#include "runtime/plant_gateway.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "random/dice.hpp"
#include "runtime/gateway_fixture.hpp"

namespace fpc {
namespace loop_plant_gateway_test {

/// Everything has come, and the loop runs, at time 0.
PlantGateway ready(const LoopFile& loop, double position = 2.0) {
  PlantGateway gateway(loop);
  gateway.tick(0.0);
  gateway.sense(0, 1.0, 0.0);
  gateway.sense(1, 0.0, 0.0);
  gateway.readBack(0, position, 0.0);
  gateway.reset(7);
  return gateway;
}

/// u(k), confirmed and read back at once; then sample k + 1.
void sample(PlantGateway& gateway, double input, double now_s) {
  gateway.tick(now_s);
  gateway.take(one(input));
  gateway.confirm(gateway.commandNumber(), now_s);
  gateway.readBack(0, gateway.command()[0], now_s + 0.5);
  gateway.tick(now_s + 1.0);
  gateway.sense(0, 1.0, now_s + 1.0);
  gateway.sense(1, 0.0, now_s + 1.0);
  gateway.advance(one(input));
}

TEST(PlantGateway, NamesWhatHasNotComeYet) {
  PlantGateway gateway(topicLoop());
  EXPECT_EQ(gateway.missing(), (std::vector<std::string>{"level", "rain", "inflow read back"}));
  EXPECT_EQ(gateway.quality()[0], Quality::kMissing);
  EXPECT_TRUE(std::isnan(gateway.measurement().outputs[0]));
  EXPECT_EQ(gateway.field(), FieldState::kUnknown);
  gateway.take(one(3.0));
  EXPECT_FALSE(gateway.commands());  // nobody knows where the input is: nothing is told
}

TEST(PlantGateway, StartsFromWhereThePlantReallyIs) {
  PlantGateway gateway = ready(topicLoop(), 7.3);
  EXPECT_EQ(gateway.measurement().input_applied[0], 7.3);
  gateway.take(one(0.0));
  EXPECT_EQ(gateway.command()[0], 6.3);  // one move from there
}

TEST(PlantGateway, GivesEverySignalItsQualityAndAge) {
  PlantGateway gateway = ready(topicLoop());
  EXPECT_EQ(gateway.quality(), std::vector<Quality>(2, Quality::kGood));
  gateway.sense(1, kNaN, 1.0);
  gateway.tick(2.5);
  gateway.advance(one(2.0));
  EXPECT_EQ(gateway.quality()[0], Quality::kStale);
  EXPECT_EQ(gateway.quality()[1], Quality::kBad);
  EXPECT_EQ(gateway.age()[0], 2.5);
  EXPECT_EQ(gateway.age()[1], 1.5);
  EXPECT_EQ(gateway.problem(), "level is stale");
}

TEST(PlantGateway, WithoutActionsHoldsThenMovesToTheFallback) {
  PlantGateway gateway = ready(topicLoop());
  sample(gateway, 2.0, 0.0);
  std::vector<double> told;
  for (int k = 1; k <= 6; ++k) {
    gateway.tick(k);
    gateway.advanceWithoutAction();
    gateway.confirm(gateway.commandNumber(), k);
    gateway.readBack(0, gateway.command()[0], k + 0.5);
    told.push_back(gateway.command()[0]);
  }
  EXPECT_EQ(told, (std::vector<double>{2.0, 2.0, 2.0, 3.0, 4.0, 4.0}));
}

TEST(PlantGateway, AFrozenHeartbeatMakesEverythingStaleAndStopsCommands) {
  PlantGateway gateway = ready(modbusLoop());
  gateway.beat(1, 0.0);
  sample(gateway, 2.5, 0.0);
  const auto number = gateway.commandNumber();
  gateway.tick(4.0);
  gateway.sense(0, 1.0, 4.0);
  gateway.beat(1, 4.0);  // the same again
  EXPECT_EQ(gateway.field(), FieldState::kFrozen);
  gateway.take(one(3.0));
  gateway.advance(one(3.0));
  EXPECT_EQ(gateway.commandNumber(), number);
  EXPECT_EQ(gateway.quality()[0], Quality::kStale);
  EXPECT_FALSE(gateway.takesActions());
  gateway.beat(2, 5.0);
  gateway.tick(5.0);
  EXPECT_EQ(gateway.field(), FieldState::kUnknown);  // it may have moved meanwhile
  gateway.readBack(0, 9.0, 5.1);
  EXPECT_EQ(gateway.field(), FieldState::kRunning);
  gateway.take(one(0.0));
  EXPECT_EQ(gateway.command()[0], 8.0);
}

TEST(PlantGateway, ThePlantsOwnHandIsFollowedAndLeftWithoutABump) {
  PlantGateway gateway = ready(topicLoop());
  sample(gateway, 2.5, 0.0);
  gateway.remote(false, 1.0);
  gateway.readBack(0, 8.0, 1.5);
  gateway.tick(2.0);
  const auto number = gateway.commandNumber();
  gateway.take(one(2.5));
  gateway.advance(one(2.5));
  EXPECT_EQ(gateway.commandNumber(), number);
  EXPECT_FALSE(gateway.takesActions());
  EXPECT_EQ(gateway.measurement().input_applied[0], 8.0);
  gateway.remote(true, 2.5);
  gateway.readBack(0, 8.0, 2.6);
  gateway.take(one(2.5));
  EXPECT_EQ(gateway.command()[0], 7.0);
}

TEST(PlantGateway, APlantThatAnotherMasterLeadsTakesNoCommands) {
  PlantGateway gateway = ready(topicLoop());
  gateway.lead(false, 0.5);
  EXPECT_EQ(gateway.missing(), std::vector<std::string>{"the plant's leadership"});
  EXPECT_EQ(gateway.field(), FieldState::kLed);
  gateway.take(one(2.5));
  EXPECT_FALSE(gateway.commands());
  gateway.lead(true, 1.0);
  gateway.readBack(0, 8.0, 1.1);
  gateway.take(one(2.5));
  EXPECT_EQ(gateway.command()[0], 7.0);
}

TEST(PlantGateway, ACommandThatMayHaveArrivedIsReadBackBeforeTheNext) {
  PlantGateway gateway = ready(topicLoop());
  gateway.take(one(3.0));
  gateway.fail(gateway.commandNumber(), 0.1);
  gateway.tick(1.0);
  gateway.advance(one(3.0));
  EXPECT_FALSE(gateway.takesActions());
  gateway.take(one(4.0));
  EXPECT_EQ(gateway.command()[0], 3.0);
  gateway.readBack(0, 2.0, 1.1);  // it did not
  gateway.take(one(4.0));
  EXPECT_EQ(gateway.command()[0], 3.0);
  EXPECT_EQ(gateway.commandNumber(), 2U);
}

/// Its own hand, without saying so; or an instrument that lies.
TEST(PlantGateway, AnInputThatIsElsewhereIsShownAndNotRunAfter) {
  PlantGateway gateway = ready(topicLoop());
  sample(gateway, 2.5, 0.0);
  for (int k = 1; k <= 4; ++k) {
    gateway.tick(k + 0.2);
    gateway.take(one(2.5 + 0.5 * k));
    EXPECT_EQ(gateway.command()[0], 2.5 + 0.5 * k);
    gateway.confirm(gateway.commandNumber(), k + 0.3);
    gateway.readBack(0, 9.0, k + 0.9);
    gateway.tick(k + 1.0);
    gateway.advance(one(2.5 + 0.5 * k));
    EXPECT_TRUE(gateway.takesActions()) << k;
    EXPECT_EQ(gateway.measurement().input_applied[0], 2.5 + 0.5 * k) << k;
    EXPECT_EQ(gateway.positions()[0], 9.0) << k;
  }
  gateway.tick(8.0);
  gateway.advance(one(4.5));
  EXPECT_TRUE(std::isnan(gateway.positions()[0]));  // nothing has come for longer than stale_s
}

TEST(PlantGateway, AReadingThatDidNotAgreeBeforeTheLinkWasLostDoesNotMoveTheCommand) {
  for (const double later : {9.0, 9.1, 6.0}) {
    PlantGateway gateway = ready(topicLoop());
    sample(gateway, 2.5, 0.0);
    gateway.readBack(0, 9.0, 1.5);
    gateway.tick(2.0);
    gateway.advance(one(2.5));
    gateway.link(false, 2.1);
    gateway.link(true, 2.2);
    gateway.readBack(0, later, 2.3);
    gateway.tick(3.0);
    gateway.advance(one(2.5));
    EXPECT_TRUE(gateway.takesActions());
    EXPECT_EQ(gateway.command()[0], later > 8.0 ? 2.5 : later) << "6: somebody has moved it";
  }
}

TEST(PlantGateway, AnActionWaitsForTheCommandAheadOfIt) {
  PlantGateway gateway = ready(topicLoop());
  gateway.take(one(3.0));
  gateway.tick(1.0);
  gateway.advance(one(3.0));
  gateway.take(one(4.0));
  EXPECT_EQ(gateway.commandNumber(), 1U);
  gateway.confirm(1, 1.1);
  EXPECT_EQ(gateway.commandNumber(), 2U);
  EXPECT_EQ(gateway.command()[0], 4.0);
}

/// A plant that takes what it is told, or not, and moves by itself when nobody commands it.
class WildPlant {
 public:
  WildPlant(PlantGateway& gateway, Dice& dice, const RegisterFormat& format)
      : gateway_(gateway), dice_(dice), format_(format) {}
  double position{2.1};

  void live(double now_s) {
    if (dice_.chance(0.1)) gateway_.link(up_ = !up_, now_s);
    if (dice_.chance(0.05)) gateway_.remote(remote_ = !remote_, now_s);
    if (dice_.chance(0.9)) gateway_.beat(++beat_, now_s);
    if (!up_) return wander();
    deliver(now_s);
    if (!remote_) wander();
    for (const std::size_t signal : {0, 1})
      if (dice_.chance(0.8)) gateway_.sense(signal, dice_.chance(0.1) ? kNaN : 1.0, now_s);
    if (dice_.chance(0.8)) gateway_.readBack(0, position, now_s + 0.01);
  }
  int writes{0};

 private:
  void wander() {  // its own control, by any amount
    if (dice_.chance(0.3)) position = *representable(format_, dice_.between(0.0, 9.9), 0.0, 10.0);
  }
  void deliver(double now_s) {
    const std::uint64_t number = gateway_.commandNumber();
    if (!gateway_.commands() || number == last_ || !remote_) return;
    last_ = number;
    if (dice_.chance(0.1)) return gateway_.fail(number, now_s);  // and it never arrived
    write(gateway_.command()[0]);
    if (dice_.chance(0.1)) return gateway_.fail(number, now_s);  // it did, the answer was lost
    gateway_.confirm(number, now_s);
  }
  void write(double value) {
    ++writes;
    const auto registers = encode(format_, value);
    ASSERT_TRUE(registers);
    ASSERT_EQ(decode(format_, *registers), value);
    ASSERT_GE(value, 0.0);
    ASSERT_LE(value, 10.0);
    ASSERT_LE(std::abs(value - position), 1.0 + 1e-12);
    position = value;
  }

  PlantGateway& gateway_;
  Dice& dice_;
  RegisterFormat format_;
  bool up_{true}, remote_{true};
  std::uint64_t beat_{0}, last_{0};
};

TEST(PlantGateway, EveryWriteKeepsBoundsAndMoveWhateverArrives) {
  const LoopFile loop = modbusLoop();
  const RegisterFormat format = loop.gateway.inputs[0].modbus.format;
  int writes = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Dice dice(seed);
    PlantGateway gateway(loop, [&](Eigen::Index, double value, double lower, double upper) {
      return representable(format, value, lower, upper);
    });
    gateway.tick(0.0);
    gateway.reset(seed);
    WildPlant plant(gateway, dice, format);
    for (int k = 1; k < 200; ++k) {
      const double now_s = k;
      plant.live(now_s - 0.4);
      gateway.tick(now_s);
      const Vector wild = one(dice.chance(0.1) ? kNaN : dice.between(-50.0, 50.0));
      if (dice.chance(0.8)) gateway.take(wild);
      plant.live(now_s + 0.1);
      gateway.tick(now_s + 0.2);
      if (dice.chance(0.8))
        gateway.advance(wild);
      else
        gateway.advanceWithoutAction();
      const Measurement& m = gateway.measurement();
      ASSERT_TRUE(m.input_applied.allFinite());
      ASSERT_GE(m.input_applied[0], 0.0);
      ASSERT_LE(m.input_applied[0], 10.0);
      if (::testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << ", sample " << k;
    }
    writes += plant.writes;
  }
  EXPECT_GT(writes, 5000);
}

TEST(PlantGateway, ALoopWithoutOneHasNone) {
  EXPECT_THROW(PlantGateway(gatewayLoop("  type: none\n")), InputError);
}

}  // namespace loop_plant_gateway_test
}  // namespace fpc
