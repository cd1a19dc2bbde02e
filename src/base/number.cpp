#include "base/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>

#include <locale.h>

namespace fpc {
namespace portable {
namespace {

locale_t plainLocale() {
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  return plain;
}

/// printf with the decimal point of the C locale, whatever the program has set.
std::string formatted(const char* format, int precision, double value) {
  std::array<char, 400> buffer{};
  const locale_t before = uselocale(plainLocale());
  std::snprintf(buffer.data(), buffer.size(), format, precision, value);
  uselocale(before);
  return buffer.data();
}

double read(const std::string& text, char** end) {
  return strtod_l(text.c_str(), end, plainLocale());
}

/// The same digits without an exponent; `text` is sign, digits, 'e', exponent.
std::string fixedForm(const std::string& text, double value) {
  const auto e = text.find('e');
  const int exponent = std::atoi(text.c_str() + e + 1);
  const auto digits = static_cast<int>(e - (text[0] == '-') - (text.find('.') < e ? 1 : 0));
  return formatted("%.*f", std::max(digits - 1 - exponent, 0), value);
}

bool startsNumber(std::string_view text) {
  const std::size_t sign = !text.empty() && text[0] == '-' ? 1 : 0;
  if (text.size() == sign) return false;
  const char first = text[sign];
  const bool hexadecimal = text.find_first_of("xX") != std::string_view::npos;
  return !hexadecimal && ((first >= '0' && first <= '9') || first == '.' || first == 'i' ||
                          first == 'I' || first == 'n' || first == 'N');
}

}  // namespace

std::string printNumber(double value) {
  if (std::isnan(value)) return std::signbit(value) ? "-nan" : "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  std::string scientific;
  for (int precision = 0; precision <= 16; ++precision) {
    scientific = formatted("%.*e", precision, value);
    if (read(scientific, nullptr) == value) break;
  }
  const std::string fixed = fixedForm(scientific, value);
  return fixed.size() <= scientific.size() ? fixed : scientific;
}

std::optional<double> parseNumber(std::string_view text) {
  if (!startsNumber(text)) return std::nullopt;
  const std::string whole(text);
  char* end = nullptr;
  const double value = read(whole, &end);
  if (end != whole.c_str() + whole.size()) return std::nullopt;
  const bool word = whole.find_first_of("iInN") != std::string::npos;
  if (std::isinf(value) && !word) return std::nullopt;
  return value;
}

}  // namespace portable

#if defined(__cpp_lib_to_chars) && __cpp_lib_to_chars >= 201611L
std::string printNumber(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::optional<double> parseNumber(std::string_view text) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto read = std::from_chars(text.data(), last, value);
  if (read.ec != std::errc() || read.ptr != last) return std::nullopt;
  return value;
}
#else
std::string printNumber(double value) { return portable::printNumber(value); }
std::optional<double> parseNumber(std::string_view text) { return portable::parseNumber(text); }
#endif

}  // namespace fpc
