// Comparing structs bit for bit, and sending messages over the wire without a master.
#pragma once

#include <ros/serialization.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "ros/conversions.hpp"

namespace fpc {

inline const StepHeader kHeader{1234500000001, 18000000000000000001u, 4294967295u};

inline bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <typename List>
inline bool sameNumbers(const List& a, const List& b) {
  if (a.size() != b.size()) return false;
  for (decltype(a.size()) i = 0; i < a.size(); ++i)
    if (!sameBits(a.data()[i], b.data()[i])) return false;
  return true;
}

inline bool sameMatrix(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && sameNumbers(a, b);
}

inline bool sameHeader(const StepHeader& a, const StepHeader& b) {
  return a.time_ns == b.time_ns && a.run_id == b.run_id && a.step == b.step;
}

inline bool sameSignals(const std::vector<SignalInfo>& a, const std::vector<SignalInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.name == q.name && p.unit == q.unit && sameBits(p.lower, q.lower) &&
           sameBits(p.upper, q.upper);
  });
}

/// Over the wire, not only through the C++ object.
template <typename Msg>
Msg sent(const Msg& msg) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(msg));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, msg);
  Msg received;
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, received);
  return received;
}

}  // namespace fpc
