// Section `gateway`: the way to a plant that is not ours.
#include <algorithm>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

constexpr int kLastRegister = 65535;

/// Of a number that is read: holding registers, or input registers.
void readTable(YamlSection& section, const std::string& key, ModbusTag& tag) {
  readOption(section, key, tag.input_table, {{"holding", false}, {"input", true}});
}

/// Register of the key `key` in the section of a signal, in its format.
void readRegister(YamlSection& section, const std::string& key, const RegisterFormat& format,
                  ModbusTag& tag) {
  tag.format = format;
  const int last = kLastRegister + 1 - registerCount(format.type);
  section.integer(key, tag.address, 0, last);
}

RegisterFormat readFormat(YamlSection& section, WordOrder order) {
  RegisterFormat format;
  format.order = order;
  readOption(section, "type", format.type);
  section.number("scale", format.scale, kFinite);
  if (format.scale == 0.0) section.fail("scale", "a number that is not 0");
  section.number("offset", format.offset, kFinite);
  readOption(section, "word_order", format.order);
  return format;
}

void readModbusTag(YamlSection& section, WordOrder order, bool is_input, GatewayTag& tag) {
  const RegisterFormat format = readFormat(section, order);
  need(section, "register", "the address of a register, from 0");
  readRegister(section, "register", format, tag.modbus);
  if (!is_input) return readTable(section, "table", tag.modbus);
  tag.readback = tag.modbus;  // what a holding register holds can be read
  readRegister(section, "readback", format, tag.readback);
  readTable(section, "readback_table", tag.readback);
}

void readTopicTag(YamlSection& section, const std::string& name, bool is_input, bool is_output,
                  GatewayTag& tag) {
  tag.topic = name + (is_input ? "/control_effort" : "/state");
  section.text("topic", tag.topic);
  if (is_input) section.text("readback", tag.readback_topic);
  if (!is_output) return;
  tag.setpoint_topic = name + "/setpoint";
  section.text("setpoint", tag.setpoint_topic);
}

enum class Group { kOutputs, kDisturbances, kInputs };

std::vector<GatewayTag> readTags(YamlSection& tags, const std::vector<std::string>& names,
                                 const GatewayParams& gateway, WordOrder order, Group group) {
  std::vector<GatewayTag> list;
  for (const auto& name : names) {
    GatewayTag tag;
    const bool is_input = group == Group::kInputs;
    if (gateway.type == GatewayType::kModbus) need(tags, name, "the register of this signal");
    YamlSection section = tags.section(name);
    if (gateway.type == GatewayType::kModbus)
      readModbusTag(section, order, is_input, tag);
    else
      readTopicTag(section, name, is_input, group == Group::kOutputs, tag);
    section.finish();
    list.push_back(std::move(tag));
  }
  return list;
}

/// A coil or discrete input.
void readBit(YamlSection& section, const std::string& key, ModbusBit& bit) {
  section.integer(key, bit.address, 0, kLastRegister);
}

void readModbus(YamlSection& gateway, ModbusParams& modbus, WordOrder& order) {
  YamlSection section = gateway.section("modbus");
  section.text("host", modbus.host);
  section.integer("port", modbus.port, 1, 65535);
  section.integer("unit", modbus.unit, 0, 255);
  section.number("poll_s", modbus.poll_s, {1e-3, 3600.0});
  section.number("timeout_s", modbus.timeout_s, {1e-3, 3600.0});
  section.number("reconnect_s", modbus.reconnect_s, {1e-3, 3600.0});
  readOption(section, "word_order", order);
  readBit(section, "automatic_coil", modbus.automatic);
  readBit(section, "remote_coil", modbus.remote);
  readOption(section, "remote_table", modbus.remote.discrete_table,
             {{"coil", false}, {"discrete", true}});
  section.integer("heartbeat_in", modbus.heartbeat_in, 0, kLastRegister);
  section.integer("heartbeat_out", modbus.heartbeat_out, 0, kLastRegister);
  section.finish();
}

/// Two registers written for two inputs must not overlap.
void checkOverlaps(YamlSection& tags, const std::vector<std::string>& names,
                   const std::vector<GatewayTag>& inputs) {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const ModbusTag &a = inputs[i].modbus, &b = inputs[j].modbus;
      const bool apart = a.address + registerCount(a.format.type) <= b.address ||
                         b.address + registerCount(b.format.type) <= a.address;
      if (!apart) tags.fail(names[i], "registers apart from those of " + names[j]);
    }
}

}  // namespace

void readGateway(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("gateway");
  GatewayParams& gateway = loop.gateway;
  const std::vector<std::string> outputs = namesOf(loop.plant_info.outputs),
                                 disturbances = namesOf(loop.plant_info.disturbances),
                                 inputs = namesOf(loop.plant_info.inputs);
  readOption(section, "type", gateway.type);
  if (gateway.enabled() && !loop.external_plant)
    section.fail("type", "none with a simulated plant; a gateway needs plant.type external");
  const bool modbus = gateway.type == GatewayType::kModbus;
  WordOrder order = WordOrder::kHighFirst;
  readModbus(section, gateway.modbus, order);
  section.number("speedup", gateway.speedup, kFinitePositive);
  gateway.stale_s =
      std::max(2.0 * loop.simulation.sample_time_s / gateway.speedup, 5.0 * gateway.modbus.poll_s);
  section.number("stale_s", gateway.stale_s, kFinitePositive);
  if (gateway.modbus.heartbeat_in >= 0) gateway.heartbeat_s = 3.0;
  section.number("heartbeat_s", gateway.heartbeat_s, kFiniteNotNegative);
  if (gateway.heartbeat_s > 0.0 && !(modbus && gateway.modbus.heartbeat_in >= 0))
    section.fail("heartbeat_s", "0 without gateway.modbus.heartbeat_in");
  section.number("readback_tolerance", gateway.readback_tolerance, {0.0, 1.0});
  section.text("enable_topic", gateway.enable_topic);
  YamlSection tags = section.section("tags");
  if (gateway.enabled()) {
    gateway.outputs = readTags(tags, outputs, gateway, order, Group::kOutputs);
    gateway.disturbances = readTags(tags, disturbances, gateway, order, Group::kDisturbances);
    gateway.inputs = readTags(tags, inputs, gateway, order, Group::kInputs);
  }
  if (modbus) checkOverlaps(tags, inputs, gateway.inputs);
  gateway.reads_back =
      std::all_of(gateway.inputs.begin(), gateway.inputs.end(),
                  [&](const GatewayTag& tag) { return modbus || !tag.readback_topic.empty(); }) &&
      gateway.enabled();
  tags.finish();
  section.finish();
}

}  // namespace fpc
