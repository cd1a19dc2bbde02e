#include "base/register_codec.hpp"

#include <cmath>
#include <cstring>
#include <limits>

namespace fpc {
namespace {

struct IntegerRange {
  double lower, upper;
};

IntegerRange rangeOf(RegisterType type) {
  switch (type) {
    case RegisterType::kInt16:
      return {-32768.0, 32767.0};
    case RegisterType::kUint16:
      return {0.0, 65535.0};
    case RegisterType::kInt32:
      return {-2147483648.0, 2147483647.0};
    case RegisterType::kUint32:
      return {0.0, 4294967295.0};
    case RegisterType::kFloat32:
      break;
  }
  return {-static_cast<double>(std::numeric_limits<float>::max()),
          static_cast<double>(std::numeric_limits<float>::max())};
}

Registers split(std::uint32_t bits, WordOrder order) {
  const auto high = static_cast<std::uint16_t>(bits >> 16U);
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  return order == WordOrder::kHighFirst ? Registers{high, low} : Registers{low, high};
}

std::uint32_t joined(const Registers& r, WordOrder order) {
  const bool high_first = order == WordOrder::kHighFirst;
  const std::uint32_t high = high_first ? r[0] : r[1];
  return high << 16U | (high_first ? r[1] : r[0]);
}

/// The raw number that the registers will hold.
double nearestRaw(RegisterType type, double raw) {
  return type == RegisterType::kFloat32 ? static_cast<double>(static_cast<float>(raw))
                                        : std::round(raw);
}

/// The next raw number above or below.
double nextRaw(RegisterType type, double raw, bool up) {
  if (type != RegisterType::kFloat32) return raw + (up ? 1.0 : -1.0);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return static_cast<double>(std::nextafter(static_cast<float>(raw), up ? kInfinity : -kInfinity));
}

}  // namespace

int registerCount(RegisterType type) {
  return type == RegisterType::kInt16 || type == RegisterType::kUint16 ? 1 : 2;
}

double decode(const RegisterFormat& format, const Registers& r) {
  double raw = 0.0;
  const std::uint32_t bits = joined(r, format.order);
  switch (format.type) {
    case RegisterType::kInt16:
      raw = static_cast<double>(static_cast<std::int16_t>(r[0]));
      break;
    case RegisterType::kUint16:
      raw = static_cast<double>(r[0]);
      break;
    case RegisterType::kInt32:
      raw = static_cast<double>(static_cast<std::int32_t>(bits));
      break;
    case RegisterType::kUint32:
      raw = static_cast<double>(bits);
      break;
    case RegisterType::kFloat32: {
      float value = 0.0F;
      std::memcpy(&value, &bits, sizeof value);
      raw = static_cast<double>(value);
      break;
    }
  }
  return format.scale * raw + format.offset;
}

std::optional<Registers> encode(const RegisterFormat& format, double value) {
  const double asked = (value - format.offset) / format.scale;
  const IntegerRange range = rangeOf(format.type);
  if (!(std::round(asked) >= range.lower && std::round(asked) <= range.upper)) return {};
  const double raw = nearestRaw(format.type, asked);
  if (format.type == RegisterType::kFloat32) {
    const auto narrow = static_cast<float>(raw);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    return split(bits, format.order);
  }
  const auto whole = static_cast<std::int64_t>(raw);
  if (registerCount(format.type) == 1)
    return Registers{static_cast<std::uint16_t>(whole & 0xFFFF), 0};
  return split(static_cast<std::uint32_t>(whole & 0xFFFFFFFF), format.order);
}

std::optional<double> representable(const RegisterFormat& format, double value, double lower,
                                    double upper) {
  const auto inside = [&](double v) { return v >= lower && v <= upper; };
  const auto shown = [&](double raw) { return format.scale * raw + format.offset; };
  const auto held = [&](double raw) {
    const IntegerRange range = rangeOf(format.type);
    return raw >= range.lower && raw <= range.upper;
  };
  const double asked = (value - format.offset) / format.scale;
  if (!std::isfinite(asked)) return {};
  const double nearest = nearestRaw(format.type, asked);
  if (!held(nearest)) return {};
  if (inside(shown(nearest))) return shown(nearest);
  const bool raise = (shown(nearest) < lower) == (format.scale > 0.0);
  const double next = nextRaw(format.type, nearest, raise);
  if (held(next) && inside(shown(next))) return shown(next);
  return {};
}

}  // namespace fpc
