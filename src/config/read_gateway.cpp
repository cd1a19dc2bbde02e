// Section `gateway`: the way to a plant that is not ours.
#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr int kLastRegister = 65535;
constexpr double kTimeoutPolls = 2.5, kShortestTimeout = 0.5, kLongestTimeout = 2.0;  // [s]

/// Of a number that is read: holding registers, or input registers.
void readTable(YamlSection& section, ModbusTag& tag) {
  readOption(section, "table", tag.input_table, {{"holding", false}, {"input", true}});
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
  return format;
}

void readModbusTag(YamlSection& section, WordOrder order, bool is_input, GatewayTag& tag) {
  const RegisterFormat format = readFormat(section, order);
  need(section, "register", "the address of a register, from 0");
  readRegister(section, "register", format, tag.modbus);
  if (!is_input) return readTable(section, tag.modbus);
  tag.readback = tag.modbus;  // what a holding register holds can be read
  readRegister(section, "readback", format, tag.readback);
  readTable(section, tag.readback);
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
  if (modbus.host.empty() || modbus.host.find_first_of(" :/") != std::string::npos)
    section.fail("host", "an IPv4 address or the name of a host, alone");
  section.integer("port", modbus.port, 1, 65535);
  section.integer("unit", modbus.unit, 0, 255);
  section.number("poll_s", modbus.poll_s, {1e-3, 3600.0});
  modbus.timeout_s = std::clamp(kTimeoutPolls * modbus.poll_s, kShortestTimeout, kLongestTimeout);
  readOption(section, "word_order", order);
  readBit(section, "automatic_coil", modbus.automatic);
  readBit(section, "remote_coil", modbus.remote);
  readOption(section, "remote_table", modbus.remote.discrete_table,
             {{"coil", false}, {"discrete", true}});
  section.integer("owner_register", modbus.owner, 0, kLastRegister);
  section.integer("heartbeat_in", modbus.heartbeat_in, 0, kLastRegister);
  section.integer("heartbeat_out", modbus.heartbeat_out, 0, kLastRegister);
  section.finish();
}

/// What stands at some addresses of one of the plant's four tables.
struct Place {
  enum Table { kHolding, kInput, kCoil, kDiscrete } table;
  int first, count;
  std::string key;  // of section gateway
};

Place placeOf(const ModbusTag& tag, const std::string& key) {
  return {tag.input_table ? Place::kInput : Place::kHolding, tag.address,
          registerCount(tag.format.type), key};
}

void addTags(const std::vector<GatewayTag>& tags, const std::vector<std::string>& names,
             std::vector<Place>& places) {
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const ModbusTag &own = tags[i].modbus, &back = tags[i].readback;
    const std::string key = "tags." + names[i];
    places.push_back(placeOf(own, key + ".register"));
    const bool another = back.input_table != own.input_table || back.address != own.address;
    if (back.address >= 0 && another) places.push_back(placeOf(back, key + ".readback"));
  }
}

std::vector<Place> placesOf(const GatewayParams& gateway, const PlantInfo& plant) {
  const ModbusParams& modbus = gateway.modbus;
  std::vector<Place> places;
  addTags(gateway.outputs, namesOf(plant.outputs), places);
  addTags(gateway.disturbances, namesOf(plant.disturbances), places);
  addTags(gateway.inputs, namesOf(plant.inputs), places);
  const Place::Table remote = modbus.remote.discrete_table ? Place::kDiscrete : Place::kCoil;
  for (const Place& bit : {Place{Place::kCoil, modbus.automatic.address, 1, "automatic_coil"},
                           Place{remote, modbus.remote.address, 1, "remote_coil"},
                           Place{Place::kHolding, modbus.owner, 1, "owner_register"},
                           Place{Place::kHolding, modbus.heartbeat_in, 1, "heartbeat_in"},
                           Place{Place::kHolding, modbus.heartbeat_out, 1, "heartbeat_out"}})
    if (bit.first >= 0) places.push_back({bit.table, bit.first, 1, "modbus." + bit.key});
  return places;
}

/// No address may mean two things.
void checkPlaces(const YamlSection& gateway, const std::vector<Place>& places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Place &a = places[i], &b = places[j];
      const bool apart = a.first + a.count <= b.first || b.first + b.count <= a.first;
      if (a.table == b.table && !apart)
        gateway.fail(a.key, "an address of its own, got " + std::to_string(a.first) +
                                ", which is of gateway." + b.key);
    }
}

/// Registers that can hold every value of the signal, and a move of an input.
void checkHolds(const YamlSection& gateway, const ModbusTag& tag, const SignalInfo& signal,
                double move) {
  const std::string key = "tags." + signal.name + ".scale";
  for (const double bound : {signal.lower, signal.upper})
    if (std::isfinite(bound) && !encode(tag.format, bound))
      gateway.fail(key, "a scale and an offset by which " + wordOf(tag.format.type) + " holds " +
                            exactText(bound) + " [" + signal.unit + "]");
  if (tag.format.type != RegisterType::kFloat32 && std::abs(tag.format.scale) > move)
    gateway.fail(key, "a step of at most the move limit, " + exactText(move) + " [" + signal.unit +
                          "], got " + exactText(std::abs(tag.format.scale)));
}

void checkMap(const YamlSection& gateway, const LoopFile& loop) {
  const GatewayParams& params = loop.gateway;
  const PlantInfo& plant = loop.plant_info;
  checkPlaces(gateway, placesOf(params, plant));
  for (std::size_t i = 0; i < plant.outputs.size(); ++i)
    checkHolds(gateway, params.outputs[i].modbus, plant.outputs[i], kInfinity);
  for (std::size_t i = 0; i < plant.disturbances.size(); ++i)
    checkHolds(gateway, params.disturbances[i].modbus, plant.disturbances[i], kInfinity);
  const InputLimits& limits = loop.simulation.actuator.limits;
  for (std::size_t i = 0; i < plant.inputs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    SignalInfo input = plant.inputs[i];
    input.lower = limits.lower[row];
    input.upper = limits.upper[row];
    checkHolds(gateway, params.inputs[i].modbus, input, limits.move[row]);
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
  section.text("enable_topic", gateway.enable_topic);
  YamlSection tags = section.section("tags");
  if (gateway.enabled()) {
    gateway.outputs = readTags(tags, outputs, gateway, order, Group::kOutputs);
    gateway.disturbances = readTags(tags, disturbances, gateway, order, Group::kDisturbances);
    gateway.inputs = readTags(tags, inputs, gateway, order, Group::kInputs);
  }
  if (modbus) checkMap(section, loop);
  gateway.reads_back =
      std::all_of(gateway.inputs.begin(), gateway.inputs.end(),
                  [&](const GatewayTag& tag) { return modbus || !tag.readback_topic.empty(); }) &&
      gateway.enabled();
  tags.finish();
  section.finish();
}

}  // namespace fpc
