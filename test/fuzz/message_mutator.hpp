// Changes some fields of a message, whichever its type: walks over the fields as ros::serialization
// does. Without bytes nothing is changed.
#pragma once

#include <ros/serialization.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fuzz/bytes.hpp"

namespace fpc::fuzz {

class MessageMutator {
 public:
  explicit MessageMutator(Bytes& bytes) : bytes_(bytes) {}

  template <typename Message>
  void next(Message& message) {
    ros::serialization::Serializer<Message>::read(*this, message);
  }
  void next(double& value) {
    if (!touched()) return;
    const int how = bytes_.below(4);
    if (how == 0) value = std::nan("");
    if (how == 1) value = -value;
    if (how == 2) value *= 1e9;
    if (how == 3) value = bytes_.number();
  }
  void next(std::uint8_t& value) { integer(value); }
  void next(std::int32_t& value) { integer(value); }
  void next(std::uint32_t& value) { integer(value); }
  void next(std::uint64_t& value) { integer(value); }
  void next(ros::Time& time) {
    integer(time.sec);
    integer(time.nsec);
  }
  void next(std::string& text) {
    if (!touched()) return;
    if (bytes_.below(2) == 0) return text.clear();
    text.push_back(static_cast<char>(bytes_.next()));
  }
  template <typename Item>
  void next(std::vector<Item>& list) {
    if (touched()) resize(list);
    for (Item& item : list) next(item);
  }

 private:
  bool touched() { return bytes_.next() >= 192; }

  template <typename Integer>
  void integer(Integer& value) {
    if (!touched()) return;
    const int how = bytes_.below(5);
    if (how == 0) ++value;
    if (how == 1) --value;
    if (how == 2) value = static_cast<Integer>(bytes_.next());
    if (how == 3) value = std::numeric_limits<Integer>::max();
    if (how == 4) value = static_cast<Integer>(value + 5000);
  }

  template <typename Item>
  void resize(std::vector<Item>& list) {
    const int how = bytes_.below(4);
    if (how == 0 && !list.empty()) list.pop_back();
    if (how == 1) list.push_back(list.empty() ? Item() : Item(list.back()));
    if (how == 2) list.clear();
    if (how == 3) list.resize(static_cast<std::size_t>(bytes_.below(9)));
  }

  Bytes& bytes_;
};

/// A copy with some fields changed.
template <typename Message>
Message mutated(Message message, Bytes& bytes) {
  MessageMutator(bytes).next(message);
  return message;
}

template <typename Message>
std::string wireOf(const Message& message) {
  std::string wire(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(wire.data()),
                                     static_cast<std::uint32_t>(wire.size()));
  ros::serialization::serialize(stream, message);
  return wire;
}

}  // namespace fpc::fuzz
