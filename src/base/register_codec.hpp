// Numbers in the 16-bit registers of a PLC: integers and floats, scaled, in either word order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fpc {

enum class RegisterType : std::uint8_t { kInt16, kUint16, kInt32, kUint32, kFloat32 };
enum class WordOrder : std::uint8_t { kHighFirst, kLowFirst };
inline std::vector<std::string> wordsOf(RegisterType) {
  return {"int16", "uint16", "int32", "uint32", "float32"};
}
inline std::vector<std::string> wordsOf(WordOrder) { return {"high_first", "low_first"}; }

/// value = scale * raw + offset.
struct RegisterFormat {
  RegisterType type{RegisterType::kFloat32};
  WordOrder order{WordOrder::kHighFirst};
  double scale{1.0};
  double offset{0.0};
};

/// Registers that a number takes: 1 or 2.
int registerCount(RegisterType type);

using Registers = std::array<std::uint16_t, 2>;

/// NaN where a float says so.
double decode(const RegisterFormat& format, const Registers& registers);
/// The nearest number that the registers can hold; nothing for what is beyond them, or no number.
std::optional<Registers> encode(const RegisterFormat& format, double value);

/// What decode() gives back of the number next to `value` that fits inside [lower, upper]; nothing
/// if none does. So a rounded number keeps the limits that the true one keeps.
std::optional<double> representable(const RegisterFormat& format, double value, double lower,
                                    double upper);

}  // namespace fpc
