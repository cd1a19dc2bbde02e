// One connection to a Modbus/TCP server. Private to the nodes; libmodbus stays in modbus_link.cpp.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "config/gateway_params.hpp"

namespace fpc {

/// The connection is of no more use: silence, garbage, or closed by the other side.
class ModbusLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Every call @throws ModbusLost. A server that answers with an exception code gives nothing back,
/// and refusal() says which.
class ModbusLink {
 public:
  explicit ModbusLink(const ModbusParams& params);  ///< looks the host up
  ~ModbusLink();
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;

  void connect();
  std::optional<double> read(const ModbusTag& tag);
  std::optional<std::uint16_t> readRegister(int address);
  std::optional<bool> readBit(const ModbusBit& bit);
  /// False: refused, and so not written.
  bool write(const ModbusTag& tag, double value);
  bool writeRegister(int address, std::uint16_t value);
  bool writeCoil(int address, bool value);
  const std::string& refusal() const { return refusal_; }

 private:
  bool answered(int result);

  void* context_{};
  std::string place_, refusal_;
};

}  // namespace fpc
