#include "base/csv_cell.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

std::string unquoted(const std::string& text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return text;
  std::string inner;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    inner += text[i];
    if (text[i] == '"' && text[i + 1] == '"' && i + 2 < text.size()) ++i;
  }
  return trimmed(inner);
}

int daysIn(int month, int year) {
  if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

/// Days since 1970-01-01 of a civil date (hinnant2013, days_from_civil).
double dayNumber(int y, int m, int d) {
  y -= m <= 2;
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097.0 + day_of_era - 719468;
}

/// Reads from left to right; a part that is not as it must be makes `ok` false for good.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}
  bool ok{true};
  bool done() const { return at_ == text_.size(); }
  char next() const { return done() ? '\0' : text_[at_]; }
  bool skip(char c) { return next() == c ? (++at_, true) : false; }
  void expect(char c) { ok = skip(c) && ok; }
  bool isDigit() const { return next() >= '0' && next() <= '9'; }

  /// Exactly `digits` digits, in lower..upper.
  int number(int digits, int lower, int upper) {
    int value = 0;
    for (int i = 0; i < digits; ++i) {
      ok = ok && isDigit();
      if (!ok) return lower;
      value = 10 * value + (text_[at_++] - '0');
    }
    ok = ok && value >= lower && value <= upper;
    return value;
  }

  /// What stands behind a point or comma, as a part of one.
  double fraction() {
    if (!skip('.') && !skip(',')) return 0.0;
    double value = 0.0, unit = 0.1;
    ok = ok && isDigit();
    for (; isDigit(); unit *= 0.1) value += unit * (text_[at_++] - '0');
    return value;
  }

 private:
  const std::string& text_;
  std::size_t at_{0};
};

double secondsOfDay(Scanner& scan) {
  const int hours = scan.number(2, 0, 23);
  scan.expect(':');
  const int minutes = scan.number(2, 0, 59);
  double seconds = 0.0;
  if (scan.skip(':')) {
    seconds = scan.number(2, 0, 59);
    seconds += scan.fraction();
  }
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

/// Seconds east of Greenwich; nothing is there for a local time.
std::optional<double> zoneOf(Scanner& scan) {
  if (scan.done()) return std::nullopt;
  if (scan.skip('Z') || scan.skip('z')) return 0.0;
  const double sign = scan.next() == '-' ? -1.0 : 1.0;
  if (!scan.skip('-')) scan.expect('+');
  const int hours = scan.number(2, 0, 23);
  const bool more = scan.skip(':') || scan.isDigit();
  return sign * (3600.0 * hours + (more ? 60.0 * scan.number(2, 0, 59) : 0.0));
}

/// The texts are the same, or both are the same number.
bool means(const std::string& cell, const std::string& word, char decimal) {
  if (cell == word) return true;
  std::string pointed = cell;
  if (decimal != '.') std::replace(pointed.begin(), pointed.end(), decimal, '.');
  const auto a = numberOf(pointed), b = numberOf(word);
  return a && b && *a == *b;
}

}  // namespace

std::vector<std::string> cellsOf(const std::string& line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == separator && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  for (auto& cell : cells) cell = unquoted(trimmed(cell));
  return cells;
}

std::optional<double> cellNumber(const std::string& cell, const CsvFormat& format) {
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN") return kNaN;
  for (const auto& word : format.missing_values)
    if (means(cell, word, format.decimal)) return kNaN;
  if (format.decimal == '.') return numberOf(cell);
  if (cell.find('.') != std::string::npos) return std::nullopt;  // thousands, or the other decimal
  std::string pointed = cell;
  std::replace(pointed.begin(), pointed.end(), format.decimal, '.');
  return numberOf(pointed);
}

std::string decimalHint(const std::string& text, char decimal) {
  const bool point = decimal == '.';
  const char other = point ? ',' : '.';
  const bool maybe = text.find(other) != std::string::npos &&
                     text.find_first_not_of("+-0123456789.,eE") == std::string::npos;
  if (!maybe) return "";
  return point ? " (decimal: point; is it comma?)" : " (decimal: comma; is it point?)";
}

namespace {

/// Days of a date YYYY-MM-DD, or DD.MM.YYYY with one or two digits of day and month.
double dateOf(Scanner& scan, const std::string& cell) {
  int year = 0, month = 0, day = 0;
  const auto shortNumber = [&](int upper) {
    const int first = scan.number(1, 0, 9);
    const int value = scan.ok && scan.isDigit() ? 10 * first + scan.number(1, 0, 9) : first;
    scan.ok = scan.ok && value >= 1 && value <= upper;
    return value;
  };
  const auto point = cell.find('.');
  if (point == 1 || point == 2) {
    day = shortNumber(31);
    scan.expect('.');
    month = shortNumber(12);
    scan.expect('.');
    year = scan.number(4, 0, 9999);
  } else {
    year = scan.number(4, 0, 9999);
    scan.expect('-');
    month = scan.number(2, 1, 12);
    scan.expect('-');
    day = scan.number(2, 1, 31);
  }
  scan.ok = scan.ok && day <= daysIn(month, year);
  return scan.ok ? dayNumber(year, month, day) : 0.0;
}

}  // namespace

std::optional<CellTime> cellTime(const std::string& cell) {
  Scanner scan(cell);
  CellTime time{dateOf(scan, cell), false};
  if (!scan.ok) return std::nullopt;
  if (scan.done()) return time;
  if (!scan.skip('T') && !scan.skip('t')) scan.expect(' ');
  double seconds = scan.ok ? secondsOfDay(scan) : 0.0;
  if (scan.ok) {
    const auto east = zoneOf(scan);
    time.zoned = east.has_value();
    seconds -= east.value_or(0.0);
  }
  if (!scan.ok || !scan.done()) return std::nullopt;
  time.days += seconds / 86400.0;
  return time;
}

}  // namespace fpc
