#include "config/gateway_params.hpp"

#include "runtime/gateway_fixture.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_gateway_params_test {

constexpr char kNone[] = "nothing was thrown";

std::string errorIn(const std::string& gateway) {
  return errorOf([&] { gatewayLoop(gateway); });
}

TEST(GatewayParams, ReadsTheTagMapOfTopics) {
  const GatewayParams gateway = topicLoop().gateway;
  EXPECT_EQ(gateway.type, GatewayType::kFloat64);
  EXPECT_EQ(gateway.outputs[0].topic, "level/state");
  EXPECT_EQ(gateway.outputs[0].setpoint_topic, "level/setpoint");
  EXPECT_EQ(gateway.disturbances[0].topic, "rain/state");
  EXPECT_EQ(gateway.inputs[0].topic, "inflow/control_effort");
  EXPECT_TRUE(gateway.reads_back);
  EXPECT_FALSE(gatewayLoop("  type: float64\n").gateway.reads_back);
}

TEST(GatewayParams, ReadsTheTagMapOfRegisters) {
  const GatewayParams gateway =
      gatewayLoop(
          "  type: modbus\n  modbus: {word_order: low_first, remote_coil: 3, remote_table: "
          "discrete}\n"
          "  tags:\n    level: {register: 7, table: input}\n"
          "    rain: {register: 2, type: int32}\n"
          "    inflow: {register: 4, type: uint16, scale: 0.01, offset: -1, readback: 6, table: "
          "input}\n")
          .gateway;
  EXPECT_TRUE(gateway.outputs[0].modbus.input_table);
  EXPECT_EQ(gateway.outputs[0].modbus.format.order, WordOrder::kLowFirst);
  EXPECT_EQ(gateway.inputs[0].modbus.address, 4);
  EXPECT_EQ(gateway.inputs[0].readback.address, 6);
  EXPECT_EQ(gateway.inputs[0].readback.format.scale, 0.01);
  EXPECT_TRUE(gateway.inputs[0].readback.input_table);
  EXPECT_FALSE(gateway.inputs[0].modbus.input_table);
  EXPECT_TRUE(gateway.modbus.remote.discrete_table);
  EXPECT_TRUE(gateway.reads_back);  // what a holding register holds can be read
  EXPECT_EQ(gateway.heartbeat_s, 0.0);
}

TEST(GatewayParams, RunsInRealtimeWhateverTheLoopSays) {
  const LoopFile loop = gatewayLoop("  type: float64\n  speedup: 5\nloop: {pace: paced}\n");
  EXPECT_EQ(loop.exchange.pace, Pace::kRealtime);
  EXPECT_EQ(loop.exchange.speedup, 5.0);
  EXPECT_EQ(loop.exchange.publishers.at("measurement"), std::vector<std::string>{"plant_gateway"});
}

TEST(GatewayParams, WhoMaySetAndEnableIsNamedByTheLoop) {
  using Names = std::vector<std::string>;
  const auto publishers = gatewayLoop("  type: float64\n").exchange.publishers;
  for (const char* key : {"setpoint", "enable", "tags", "services"})
    EXPECT_EQ(publishers.at(key), Names()) << key;  // anyone
  const auto named =
      gatewayLoop("  type: float64\nloop: {publishers: {setpoint: [hmi], enable: [panel]}}\n")
          .exchange.publishers;
  EXPECT_EQ(named.at("setpoint"), (Names{"hmi", "plant_gateway"}));  // which forwards those of hmi
  EXPECT_EQ(named.at("enable"), Names{"panel"});
}

TEST(GatewayParams, ErrorsNameKeyAndWhatWasExpected) {
  expectWords(errorIn("  type: modbus\n"), {"gateway.tags", "level", "register"});
  expectWords(errorIn("  type: opc\n"), {"gateway.type", "modbus"});
  expectWords(errorIn("  type: float64\n  heartbeat_s: 3\n"), {"heartbeat_s", "heartbeat_in"});
  expectWords(errorIn("  type: float64\n  tags: {pump: {topic: a}}\n"), {"gateway.tags", "pump"});
  const std::string tags =
      "  type: modbus\n  tags:\n    level: {register: 0}\n    rain: {register: 2}\n";
  expectWords(errorIn(tags + "    inflow: {register: 70000}\n"), {"register", "65534"});
  expectWords(errorIn(tags + "    inflow: {register: 4, scale: 0}\n"), {"scale"});
}

TEST(GatewayParams, NoAddressOfTheMapMeansTwoThings) {
  const auto error = [](const std::string& modbus, const std::string& inflow,
                        const std::string& rain = "register: 2") {
    return errorIn("  type: modbus\n  modbus: {" + modbus +
                   "}\n  tags:\n    level: {register: 0}\n    rain: {" + rain + "}\n    inflow: {" +
                   inflow + "}\n");
  };
  const std::string apart = "register: 4";
  EXPECT_EQ(error("heartbeat_in: 20, heartbeat_out: 21, owner_register: 22, automatic_coil: 0, "
                  "remote_coil: 1",
                  "register: 4, readback: 6"),
            kNone);
  EXPECT_EQ(error("automatic_coil: 1, remote_coil: 1, remote_table: discrete", apart), kNone);
  // A float at 0 also has register 1.
  expectWords(error("", "register: 1"),
              {"gateway.tags.inflow.register", "an address of its own", "tags.level.register"});
  expectWords(error("", apart, "register: 1"), {"tags.rain.register", "tags.level.register"});
  expectWords(error("", "register: 4, readback: 2"), {"inflow.readback", "tags.rain.register"});
  expectWords(error("heartbeat_out: 5", apart), {"modbus.heartbeat_out", "tags.inflow.register"});
  expectWords(error("heartbeat_in: 9, heartbeat_out: 9", apart),
              {"heartbeat_out", "modbus.heartbeat_in"});
  expectWords(error("owner_register: 4", apart), {"owner_register", "tags.inflow.register"});
  expectWords(error("automatic_coil: 1, remote_coil: 1", apart),
              {"remote_coil", "modbus.automatic_coil"});
}

TEST(GatewayParams, RegistersHoldTheRangeAndAMove) {
  const auto error = [](const std::string& level, const std::string& inflow) {
    return errorIn("  type: modbus\n  tags:\n    level: {register: 0, " + level +
                   "}\n    rain: {register: 2}\n    inflow: {register: 4, " + inflow + "}\n");
  };
  EXPECT_EQ(error("type: uint16, scale: 0.001", "type: int16, scale: 1"), kNone);
  expectWords(error("type: uint16, scale: 0.00001", "type: int16"),
              {"gateway.tags.level.scale", "uint16 holds 4 [m]"});
  expectWords(error("type: int16, offset: -40000", "type: int16"), {"tags.level.scale"});
  expectWords(error("type: float32", "type: uint16, offset: 1"), {"tags.inflow.scale", "holds 0"});
  expectWords(error("type: float32", "type: int16, scale: 1.5"),
              {"tags.inflow.scale", "the move limit, 1 [m3/h]", "got 1.5"});
}

TEST(GatewayParams, AHostIsOneWord) {
  for (const char* host : {"''", "tcp://plc", "10.0.0.7:502", "'my plc'"})
    expectWords(errorIn("  type: float64\n  modbus: {host: " + std::string(host) + "}\n"),
                {"gateway.modbus.host", "IPv4 address or the name of a host"});
}

TEST(GatewayParams, ASimulatedPlantHasNone) {
  expectWords(errorOf([] { parseLoop(smallLoop() + "gateway: {type: float64}\n", "small"); }),
              {"gateway.type", "external"});
}

TEST(PlausibilityFile, TakesItsDefaultsFromThePlantAndTheActuator) {
  const PlausibilityParams params = gatewayLoop("  type: none\n").plausibility;
  EXPECT_TRUE(params.enabled);
  EXPECT_EQ(params.hold_samples, 3);
  EXPECT_EQ(params.fallback, one(4.0));
  EXPECT_NEAR(params.outputs[0].lower, -0.4, 1e-12);
  EXPECT_NEAR(params.outputs[0].upper, 4.4, 1e-12);
  EXPECT_EQ(params.outputs[0].jump, 2.0);
  EXPECT_EQ(params.disturbances[0].jump, std::numeric_limits<double>::infinity());
  EXPECT_EQ(params.needs, (std::vector<bool>{true, false}));  // a PI without feed-forward
}

TEST(PlausibilityFile, ErrorsNameKeyAndWhatWasExpected) {
  const auto error = [](const std::string& text) {
    return errorOf([&] { gatewayLoop("  type: none\nplausibility: " + text + "\n"); });
  };
  expectWords(error("{signals: {level: {range: [5, 1]}}}"), {"plausibility.signals.level.range"});
  expectWords(error("{signals: {level: {substitute: guess}}}"), {"substitute", "last_good"});
  expectWords(error("{signals: {inflow: {range: [5, 6]}}}"), {"plausibility.signals", "inflow"});
  expectWords(error("{hold_samples: -2}"), {"hold_samples"});
}

}  // namespace config_gateway_params_test
}  // namespace fpc
