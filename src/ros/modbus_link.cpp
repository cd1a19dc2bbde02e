#include "ros/modbus_link.hpp"

#include <modbus/modbus.h>

#include <cerrno>
#include <cmath>

#include "ros/neighbours.hpp"

namespace fpc {
namespace {

modbus_t* of(void* context) { return static_cast<modbus_t*>(context); }

/// The server understood and said no; the connection is in order.
bool isException(int code) { return code > MODBUS_ENOBASE && code <= EMBXGTAR; }

}  // namespace

ModbusLink::ModbusLink(const ModbusParams& params)
    : place_(params.host + ":" + std::to_string(params.port)) {
  const std::string address = addressOf(params.host);
  if (address.empty()) throw ModbusLost("no connection to " + place_ + ": no such host is known");
  context_ = modbus_new_tcp(address.c_str(), params.port);
  if (context_ == nullptr) throw ModbusLost("no connection to " + place_ + ": out of memory");
  const double whole = std::floor(params.timeout_s);
  const auto seconds = static_cast<std::uint32_t>(whole);
  const auto micros = static_cast<std::uint32_t>(1e6 * (params.timeout_s - whole));
  modbus_set_response_timeout(of(context_), seconds, micros);
  modbus_set_byte_timeout(of(context_), seconds, micros);
  modbus_set_slave(of(context_), params.unit);
}

ModbusLink::~ModbusLink() {
  modbus_close(of(context_));
  modbus_free(of(context_));
}

void ModbusLink::connect() {
  if (modbus_connect(of(context_)) != 0)
    throw ModbusLost("no connection to " + place_ + ": " + modbus_strerror(errno));
}

/// False: an exception code. Whatever else went wrong leaves the stream in an unknown place.
bool ModbusLink::answered(int result) {
  if (result >= 0) return true;
  const int code = errno;
  refusal_ = place_ + ": " + modbus_strerror(code);
  if (!isException(code)) throw ModbusLost(refusal_);
  return false;
}

std::optional<double> ModbusLink::read(const ModbusTag& tag) {
  Registers registers{};
  const int count = registerCount(tag.format.type);
  const auto read = tag.input_table ? modbus_read_input_registers : modbus_read_registers;
  if (!answered(read(of(context_), tag.address, count, registers.data()))) return {};
  return decode(tag.format, registers);
}

std::optional<std::uint16_t> ModbusLink::readRegister(int address) {
  std::uint16_t value = 0;
  if (!answered(modbus_read_registers(of(context_), address, 1, &value))) return {};
  return value;
}

std::optional<bool> ModbusLink::readBit(const ModbusBit& bit) {
  std::uint8_t value = 0;
  const auto read = bit.discrete_table ? modbus_read_input_bits : modbus_read_bits;
  if (!answered(read(of(context_), bit.address, 1, &value))) return {};
  return value != 0;
}

bool ModbusLink::write(const ModbusTag& tag, double value) {
  const auto registers = encode(tag.format, value);
  if (!registers) {
    refusal_ = place_ + ": a command that its registers cannot hold";
    return false;
  }
  const int count = registerCount(tag.format.type);
  return answered(modbus_write_registers(of(context_), tag.address, count, registers->data()));
}

bool ModbusLink::writeRegister(int address, std::uint16_t value) {
  return answered(modbus_write_registers(of(context_), address, 1, &value));
}

bool ModbusLink::writeCoil(int address, bool value) {
  return answered(modbus_write_bit(of(context_), address, value ? 1 : 0));
}

}  // namespace fpc
