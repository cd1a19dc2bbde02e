// What is read back of a valve may be anything: no reading leads a command.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "base/register_codec.hpp"
#include "random/dice.hpp"
#include "runtime/factory.hpp"
#include "runtime/gateway_fixture.hpp"
#include "runtime/plant_gateway.hpp"
#include "runtime/plant_session.hpp"

namespace fpc {
namespace loop_lying_position_test {

constexpr double kMove = 1.0, kBand = 0.2;  // of the fixture's inflow

using Lie = std::function<double(double)>;
double truth(double position) { return position; }

/// A tank that does what it is told, behind a gateway, under the PI of the fixture.
class Tank {
 public:
  explicit Tank(const LoopFile& loop)
      : gateway_(new PlantGateway(loop, rounding(loop))),
        session_(std::unique_ptr<Process>(gateway_), lockstepPolicy(loop)),
        law_(makeControllerSession(loop)) {
    position_ = gateway_->command()[0];
    read(truth);
    session_.begin(1);
    law_.announce(1);
    session_.start(0.0);
  }

  /// One sample at whose end the position is read so.
  void live(const Lie& lie) {
    law_.plantTakesActions(session_.takesActions());
    law_.receive(gateway_->measurement());
    asked_ = law_.answer().base.input[0];
    before_ = gateway_->command()[0];
    session_.receive(law_.answer().base);
    if (gateway_->commands()) position_ = gateway_->command()[0];
    gateway_->confirm(gateway_->commandNumber(), now_s_ + 0.1);
    level_ += 0.1 * (position_ - 2.0 * level_ + 0.3 * std::sin(0.05 * now_s_));
    now_s_ += 1.0;
    read(lie);
    session_.advance(now_s_);
  }
  void loseLink() {
    gateway_->link(false, now_s_ + 0.3);
    gateway_->link(true, now_s_ + 0.4);
  }

  double asked() const { return asked_; }
  double before() const { return before_; }
  double command() const { return gateway_->command()[0]; }
  double level() const { return level_; }
  bool alarm() const { return !session_.stuck().empty(); }
  bool takesActions() const { return session_.takesActions(); }

 private:
  static PlantGateway::Rounding rounding(const LoopFile& loop) {
    if (loop.gateway.type != GatewayType::kModbus) return nullptr;
    return [format = loop.gateway.inputs[0].modbus.format](Eigen::Index, double value, double lower,
                                                           double upper) {
      return representable(format, value, lower, upper);
    };
  }
  void read(const Lie& lie) {
    gateway_->tick(now_s_);
    gateway_->beat(++beat_, now_s_);
    gateway_->sense(0, level_, now_s_);
    gateway_->sense(1, 0.0, now_s_);
    const double shown = lie(position_);
    if (shown < kSilent) gateway_->readBack(0, shown, now_s_);
  }

 public:
  static constexpr double kSilent = 1e6;  ///< a lie that is not even told

 private:
  PlantGateway* gateway_;  // the session's
  PlantSession session_;
  ControllerSession law_;
  double level_{1.0}, position_{}, now_s_{}, asked_{}, before_{};
  std::uint64_t beat_{};
};

LoopFile loopOf(GatewayType type, bool hold) {
  LoopFile loop = type == GatewayType::kModbus ? modbusLoop() : topicLoop();
  loop.stuck.hold = hold;
  return loop;
}

/// Offsets, steps, drifts, noise, quantisation, readings that are dead.
Lie anyLie(Dice& dice, double& at_worst) {
  const double size = kMove * dice.between(-10.0, 10.0);
  at_worst = std::abs(size);
  switch (dice.whole(0, 6)) {
    case 0:
      return [size](double p) { return p + size; };
    case 1: {
      const auto count = std::make_shared<int>(0);
      return [=](double p) { return ++*count % 40 < 20 ? p : p + size; };
    }
    case 2: {
      at_worst = 3.0 * std::abs(size);
      const auto drift = std::make_shared<double>(0.0);
      return [=](double p) { return p + (*drift += 0.02 * size); };
    }
    case 3:
      return [size, &dice](double p) { return p + dice.between(-std::abs(size), std::abs(size)); };
    case 4:
      return [size](double p) { return std::round(p / size) * size; };
    case 5:
      at_worst = 10.0 * kMove;
      return [size](double) { return 5.0 + 0.5 * size; };
    default:
      at_worst = 10.0 * kMove;
      return [size](double) { return size > 0.0 ? std::nan("") : Tank::kSilent; };
  }
}

/// The same bits as without the lie.
TEST(LyingPosition, AnInputThatGoesOnIsTouchedByNoReading) {
  for (const GatewayType type : {GatewayType::kFloat64, GatewayType::kModbus})
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
      Dice dice(seed);
      double at_worst = 0.0;
      const Lie lie = anyLie(dice, at_worst);
      Tank lied(loopOf(type, false)), honest(loopOf(type, false));
      for (int k = 0; k < 150; ++k) {
        lied.live(k < 10 ? truth : lie);
        honest.live(truth);
        ASSERT_EQ(lied.command(), honest.command()) << "seed " << seed << ", sample " << k;
        ASSERT_TRUE(lied.takesActions());
      }
    }
}

/// Never further than a move from what the law asks and from the command before, inside the bounds.
TEST(LyingPosition, AnInputThatIsHeldIsLedByNoReading) {
  int alarms = 0;
  for (const GatewayType type : {GatewayType::kFloat64, GatewayType::kModbus})
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
      Dice dice(seed);
      double at_worst = 0.0;
      const Lie lie = anyLie(dice, at_worst);
      Tank tank(loopOf(type, true));
      bool said = false;
      for (int k = 0; k < 150; ++k) {
        tank.live(k < 10 ? truth : lie);
        ASSERT_LE(std::abs(tank.command() - tank.asked()), kMove + 1e-9) << seed << ", " << k;
        ASSERT_LE(std::abs(tank.command() - tank.before()), kMove + 1e-9) << seed << ", " << k;
        ASSERT_LE(std::abs(tank.command() - 2.0), 3.0 * kMove) << seed << ", " << k;
        said = said || tank.alarm();
      }
      alarms += said ? 1 : 0;
      EXPECT_FALSE(said && at_worst < kBand) << seed;
    }
  EXPECT_GT(alarms, 150);
}

TEST(LyingPosition, AnOffsetBeyondTheBandIsAnAlarmWithinItNone) {
  for (const GatewayType type : {GatewayType::kFloat64, GatewayType::kModbus})
    for (const bool hold : {false, true})
      for (const double moves :
           {-10.0, -2.5, -2.0, -1.5, -1.0, -0.5, -0.15, 0.15, 0.5, 1.0, 1.5, 2.0, 2.5, 10.0}) {
        Tank tank(loopOf(type, hold));
        for (int k = 0; k < 30; ++k) tank.live(truth);
        for (int k = 0; k < 30; ++k) tank.live([=](double p) { return p + moves * kMove; });
        EXPECT_EQ(tank.alarm(), std::abs(moves) * kMove > kBand) << moves;
        EXPECT_EQ(tank.takesActions(), !(hold && tank.alarm())) << moves;
        for (int k = 0; k < 60; ++k) tank.live(truth);
        EXPECT_FALSE(tank.alarm()) << moves;
        EXPECT_TRUE(tank.takesActions()) << moves;
        EXPECT_NEAR(tank.level(), 1.0, 0.3) << moves;
      }
}

TEST(LyingPosition, ALinkThatComesAndGoesDoesNotAddAnOffsetUp) {
  for (const bool hold : {false, true}) {
    Tank tank(loopOf(GatewayType::kModbus, hold));
    for (int k = 0; k < 500; ++k) {
      if (k > 60 && k % 7 == 0) tank.loseLink();
      tank.live(k < 30 ? Lie(truth) : [](double p) { return p + 3.0 * kMove; });
      ASSERT_LE(std::abs(tank.command() - 2.0), 2.0 * kMove) << k;
    }
  }
}

/// Writes that are confirmed and lost, to a plant that refuses what is too far from where it is.
TEST(LyingPosition, APlantThatDidNotFollowIsTakenUpWhereItFollowedLast) {
  LoopFile loop = loopOf(GatewayType::kFloat64, true);
  loop.stuck.tolerance = kMove / 10.0;
  PlantGateway* gateway = new PlantGateway(loop);
  PlantSession session(std::unique_ptr<Process>(gateway), lockstepPolicy(loop));
  double position = 2.0, now_s = 0.0;
  gateway->tick(0.0);
  gateway->readBack(0, position, 0.0);
  session.begin(1);
  session.start(0.0);
  double asked = 2.0;
  for (int k = 0; k < 40; ++k) {
    if (k < 8) asked = std::min(6.0, gateway->command()[0] + kMove);
    if (!session.takesActions()) asked = gateway->command()[0];
    session.receive({gateway->measurement().header, one(asked), ActionSource::kBase});
    gateway->confirm(gateway->commandNumber(), now_s + 0.1);
    const double told = gateway->command()[0];
    if (k > 12 && std::abs(told - position) <= kMove + 1e-9) position = told;
    now_s += 1.0;
    gateway->tick(now_s);
    gateway->readBack(0, position, now_s);
    session.advance(now_s);
  }
  EXPECT_TRUE(session.takesActions());
  EXPECT_EQ(session.stuck(), "");
  EXPECT_EQ(position, gateway->command()[0]);
}

}  // namespace loop_lying_position_test
}  // namespace fpc
