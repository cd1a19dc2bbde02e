// Section `gateway`: how a plant that is not ours is reached, signal by signal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/register_codec.hpp"

namespace fpc {

enum class GatewayType : std::uint8_t {
  kNone,     ///< the plant's own node speaks the exchange
  kFloat64,  ///< std_msgs/Float64 topics, one per signal
  kModbus,   ///< Modbus/TCP
};
inline std::vector<std::string> wordsOf(GatewayType) { return {"none", "float64", "modbus"}; }

/// A register (or two) of the plant.
struct ModbusTag {
  int address{-1};          ///< of the first register, from 0; -1: none
  bool input_table{false};  ///< an input register (read only), not a holding register
  RegisterFormat format;
};

/// A coil, a discrete input or a whole register that says one thing.
struct ModbusBit {
  int address{-1};  ///< -1: none
  bool discrete_table{false};
};

/// One signal of the plant, or the same of an input with what is read back of it.
struct GatewayTag {
  std::string topic, readback_topic;  ///< Float64; empty: none
  std::string setpoint_topic;         ///< of an output: setpoints of others
  ModbusTag modbus, readback;
};

struct ModbusParams {
  std::string host{"127.0.0.1"};
  int port{502};
  int unit{1};            ///< unit identifier of the server
  double poll_s{0.2};     ///< all registers are read so often
  double timeout_s{0.5};  ///< of one answer
  ModbusBit automatic;    ///< coil, written: 1 while the loop has the inputs
  ModbusBit remote;       ///< coil or discrete input, read: 1 while the plant takes commands
  int owner{-1};          ///< holding register: the word of the master that leads, 0: nobody
  int heartbeat_in{-1};   ///< holding register that the plant counts up
  int heartbeat_out{-1};  ///< holding register that the gateway counts up
};

struct GatewayParams {
  GatewayType type{GatewayType::kNone};
  double stale_s{};          ///< a value older than this is not accepted
  double heartbeat_s{};      ///< the plant's heartbeat must change within; 0: it has none
  bool reads_back{false};    ///< what is read back of the inputs is known
  double speedup{1.0};       ///< of a plant that lives faster than the clock (a demo)
  std::string enable_topic;  ///< std_msgs/Bool; false: the plant's own hand
  ModbusParams modbus;
  std::vector<GatewayTag> outputs, disturbances, inputs;  ///< in the plant's order
  bool enabled() const { return type != GatewayType::kNone; }
};

}  // namespace fpc
