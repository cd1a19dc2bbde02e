// The stirred tank of cstr_modbus behind its gateway, with a wire that lies for a while: the loop
// must come back, and the reactor must not have gone out meanwhile.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/register_codec.hpp"
#include "random/dice.hpp"
#include "runtime/factory.hpp"
#include "runtime/plant_gateway.hpp"

namespace fpc {
namespace loop_broken_wire_test {

constexpr double kPeriod = 0.1;  // [s] of wall time per sample
constexpr double kMove = 4.0;    // [l/min] that the PLC lets through at once
constexpr double kSetpoint = 0.12;
constexpr double kGoneOut = 0.3;  // [mol/l] a reactor with more than this has gone out

using Lie = std::function<double(double)>;
double truth(double value) { return value; }

/// A float32 whose two registers were swapped on the way.
double swapped(double value) {
  const auto sent = encode({RegisterType::kFloat32, WordOrder::kHighFirst}, value);
  return decode({RegisterType::kFloat32, WordOrder::kLowFirst}, *sent);
}

class BrokenWire {
 public:
  BrokenWire()
      : loop_(readLoop("cstr_modbus", {{"setpoint.schedule", "[]"}, {"sampling.duration_h", "0"}})),
        reactor_(makeSimulation(readLoop("cstr_tracking", {{"sampling.duration_h", "0"}}))),
        session_(makeControllerSession(loop_)),
        gateway_(loop_, rounding()) {
    session_.setModel(loop_.model);
    reactor_.reset(1);
    flow_ = gateway_.command()[0];
    gateway_.tick(0.0);
    read(truth, truth);
    session_.announce(1);
    gateway_.reset(1);
  }

  /// One sample while the analyser's and the valve's registers are read so.
  void live(const Lie& analyser, const Lie& valve) {
    answer();
    obey(valve);
    reactor_.advance(Vector::Constant(1, flow_));
    now_s_ += kPeriod;
    gateway_.tick(now_s_);
    read(analyser, valve);
    gateway_.advance(gateway_.command());
    most_ = std::max(most_, concentration());
  }
  void live(int samples, const Lie& analyser = truth, const Lie& valve = truth) {
    for (int k = 0; k < samples; ++k) live(analyser, valve);
  }

  double concentration() const { return reactor_.measurement().outputs[0]; }
  double mostUnburnt() const { return most_; }
  int refused() const { return refused_; }
  ActionSource source() const { return session_.answer().base.source; }
  std::string remark() const { return textOf(session_.answer().events); }

 private:
  PlantGateway::Rounding rounding() const {
    return [format = loop_.gateway.inputs[0].modbus.format](Eigen::Index, double value,
                                                            double lower, double upper) {
      return representable(format, value, lower, upper);
    };
  }
  void read(const Lie& analyser, const Lie& valve) {
    gateway_.beat(++beat_, now_s_);
    gateway_.sense(0, analyser(concentration()), now_s_);
    gateway_.readBack(0, valve(flow_), now_s_);
  }
  void answer() {
    session_.plantTakesActions(gateway_.takesActions());
    session_.receive(gateway_.measurement());
    gateway_.take(session_.answer().base.input);
  }
  /// What the PLC does with a command.
  void obey(const Lie& valve) {
    if (!gateway_.commands() || gateway_.commandNumber() == told_) return;
    told_ = gateway_.commandNumber();
    const double asked = gateway_.command()[0];
    const bool allowed = std::abs(asked - flow_) <= kMove + 1e-9;
    if (allowed) flow_ = asked;
    refused_ += allowed ? 0 : 1;
    gateway_.confirm(told_, now_s_ + 0.2 * kPeriod);
    gateway_.readBack(0, valve(flow_), now_s_ + 0.4 * kPeriod);
  }

  LoopFile loop_;
  Simulation reactor_;
  ControllerSession session_;
  PlantGateway gateway_;
  double now_s_{}, flow_{}, most_{};
  std::uint64_t beat_{}, told_{};
  int refused_{};
};

void expectCalm(BrokenWire& wire, const std::string& where) {
  EXPECT_LT(wire.mostUnburnt(), kGoneOut) << where << ": the reactor has gone out";
  EXPECT_TRUE(wire.source() == ActionSource::kBase || wire.source() == ActionSource::kClipped)
      << where << ": " << wire.remark();
  EXPECT_NEAR(wire.concentration(), kSetpoint, 0.02) << where;
  EXPECT_EQ(wire.refused(), 0) << where;
}

TEST(BrokenWire, AQuietOneKeepsTheSetpoint) {
  BrokenWire wire;
  wire.live(300);
  expectCalm(wire, "no fault");
}

TEST(BrokenWire, SwappedWordsDoNotPutTheReactorOut) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Dice dice(seed);
    BrokenWire wire;
    wire.live(dice.whole(20, 150));
    wire.live(20, swapped);
    wire.live(300);
    expectCalm(wire, "seed " + std::to_string(seed));
  }
}

TEST(BrokenWire, AValveThatLiesAboutItsPositionDoesNotPutTheReactorOut) {
  for (const double lie : {0.0, 50.0, 150.0, 200.0}) {
    BrokenWire wire;
    wire.live(100);
    wire.live(15, truth, [lie](double) { return lie; });
    wire.live(300);
    expectCalm(wire, "position " + std::to_string(lie));
  }
}

}  // namespace loop_broken_wire_test
}  // namespace fpc
