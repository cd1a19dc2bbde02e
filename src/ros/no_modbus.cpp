// In the place of modbus_field.cpp where libmodbus is not there.
#include "fmbpc/base/input_error.hpp"
#include "ros/field.hpp"

namespace fpc {

std::unique_ptr<Field> makeModbusField(const LoopFile& loop) {
  throw InputError(loop.name +
                   ": gateway.type: expected another type than modbus: fmbpc was built "
                   "without libmodbus (Debian: libmodbus-dev)");
}

}  // namespace fpc
