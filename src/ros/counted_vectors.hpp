// Lists in messages of strangers: roscpp makes room for as many elements as a list says it has,
// gigabytes at a word of four bytes, before it looks whether they are there.
#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace ros::serialization {

/// Is preferred to roscpp's own, which takes any stream, wherever a message is read. Each element
/// takes a byte at least.
template <typename T, typename Allocator>
inline void deserialize(IStream& stream, std::vector<T, Allocator>& values) {
  std::uint32_t count = 0;
  if (stream.getLength() >= sizeof count) std::memcpy(&count, stream.getData(), sizeof count);
  if (count > stream.getLength()) throwStreamOverrun();
  VectorSerializer<T, Allocator>::read(stream, values);
}

}  // namespace ros::serialization
