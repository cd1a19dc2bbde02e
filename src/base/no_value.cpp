#include "base/no_value.hpp"

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace fpc {
namespace {

constexpr std::uint64_t kQuietNaN = 0x7ff8000000000000;  // IEEE 754, no payload
constexpr std::uint64_t kReasons = 0x00000000464d5000;   // below it stands which: nobody else's

}  // namespace

double noValue(NoValue why) {
  const std::uint64_t bits = kQuietNaN | kReasons | static_cast<std::uint64_t>(why);
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

NoValue whyNoValue(double value) {
  if (!std::isnan(value)) return NoValue::kNoNumber;
  for (const NoValue why : {NoValue::kStale, NoValue::kMissing}) {
    const double known = noValue(why);
    if (std::memcmp(&known, &value, sizeof(value)) == 0) return why;
  }
  return NoValue::kNoNumber;
}

}  // namespace fpc
