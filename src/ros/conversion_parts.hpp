// Pieces that all conversions share.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/types.hpp"
#include "ros/conversions.hpp"

namespace fpc::conversion {

inline std::vector<double> numbers(const Vector& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

inline Vector vector(const std::vector<double>& numbers) {
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

template <typename Msg, typename Struct>
std::vector<Msg> list(const std::vector<Struct>& structs) {
  std::vector<Msg> messages;
  messages.reserve(structs.size());
  for (const Struct& item : structs) messages.push_back(toMsg(item));
  return messages;
}

template <typename Struct, typename Msg>
std::vector<Struct> structs(const std::vector<Msg>& messages) {
  std::vector<Struct> list;
  list.reserve(messages.size());
  for (const Msg& item : messages) list.push_back(fromMsg(item));
  return list;
}

template <typename Enum>
constexpr std::uint8_t number(Enum value) {
  return static_cast<std::uint8_t>(value);
}

/// @throws InputError unless first <= value <= last.
template <typename Enum>
Enum enumeration(std::uint8_t value, Enum first, Enum last, const char* field) {
  if (value < number(first) || value > number(last))
    throw InputError(std::string(field) + " = " + std::to_string(value) + ": expected " +
                     std::to_string(number(first)) + " to " + std::to_string(number(last)));
  return static_cast<Enum>(value);
}

template <typename Msg>
void fillHeader(Msg& msg, const StepHeader& header) {
  msg.header.stamp = toStamp(header.time_ns);
  msg.run_id = header.run_id;
  msg.step = header.step;
}

template <typename Msg>
StepHeader stepHeader(const Msg& msg) {
  return {fromStamp(msg.header.stamp), msg.run_id, msg.step};
}

}  // namespace fpc::conversion
