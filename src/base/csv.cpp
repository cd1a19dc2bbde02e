#include "fmbpc/base/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
const std::string kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets put it before UTF-8

std::string trimmed(const std::string& cell) {
  const auto from = cell.find_first_not_of(" \t\r\"");
  if (from == std::string::npos) return {};
  return cell.substr(from, cell.find_last_not_of(" \t\r\"") - from + 1);
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  for (auto comma = line.find(','); comma != std::string::npos; comma = line.find(',', from)) {
    cells.push_back(trimmed(line.substr(from, comma - from)));
    from = comma + 1;
  }
  cells.push_back(trimmed(line.substr(from)));
  return cells;
}

int daysIn(int month, int year) {
  if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

/// Days since 1970-01-01 of a civil date (Hinnant 2013, days_from_civil).
std::optional<double> dayOf(const std::string& cell) {
  int y = 0, m = 0, d = 0, used = 0;
  if (std::sscanf(cell.c_str(), "%4d-%2d-%2d%n", &y, &m, &d, &used) != 3) return {};
  if (used != static_cast<int>(cell.size()) || y < 0 || m < 1 || m > 12) return {};
  if (d < 1 || d > daysIn(m, y)) return {};
  y -= m <= 2;
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097.0 + day_of_era - 719468;
}

/// A finite number, or NaN for a missing one ("nan" is how other programs write an empty cell).
std::optional<double> numberOf(const std::string& cell) {
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN") return kMissing;
  const bool plus = cell.front() == '+' && cell.size() > 1 && cell[1] != '-';
  double value = 0.0;
  const char* end = cell.data() + cell.size();
  const auto result = std::from_chars(cell.data() + plus, end, value);
  if (result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return {};
  return value;
}

void readHeader(const std::string& line, CsvTable& table) {
  std::set<std::string> seen;
  for (const auto& cell : cellsOf(line)) {
    const auto open = cell.find('[');
    const bool has_unit = open != std::string::npos && cell.back() == ']';
    table.names.push_back(trimmed(has_unit ? cell.substr(0, open) : cell));
    table.units.push_back(has_unit ? cell.substr(open + 1, cell.size() - open - 2) : "");
    require(!table.names.back().empty(), table.file + ":1", "a name for every column");
    require(seen.insert(table.names.back()).second,
            table.file + ":1: column '" + table.names.back() + "'", "every column name only once");
  }
}

/// What a column has been seen to hold: the line of the first cell of each kind, 0 if there is
/// none.
struct ColumnKind {
  std::size_t number{}, date{}, other{};
  std::string text;  ///< of the first other cell
};

double readCell(const std::string& cell, std::size_t line, ColumnKind& kind) {
  if (const auto value = numberOf(cell)) {
    if (kind.number == 0 && !std::isnan(*value)) kind.number = line;
    return *value;
  }
  if (const auto day = dayOf(cell)) {
    if (kind.date == 0) kind.date = line;
    return *day;
  }
  if (kind.other == 0) kind = {kind.number, kind.date, line, cell};
  return kMissing;
}

std::vector<std::vector<double>> readRows(std::istream& stream, const CsvTable& table,
                                          std::vector<ColumnKind>& kinds) {
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    if (trimmed(line).empty()) continue;
    const auto cells = cellsOf(line);
    require(cells.size() == table.names.size(), table.file + ":" + std::to_string(number),
            std::to_string(table.names.size()) + " cells, got " + std::to_string(cells.size()));
    std::vector<double> row(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) row[i] = readCell(cells[i], number, kinds[i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

void checkColumn(const CsvTable& table, const std::string& name, const ColumnKind& kind) {
  const auto at = [&](std::size_t line) {
    return table.file + ":" + std::to_string(line) + ": column '" + name + "'";
  };
  const bool has_values = kind.number != 0 || kind.date != 0;
  require(kind.other == 0 || !has_values, at(kind.other),
          (kind.number != 0 ? "a finite number, got '" : "a date, got '") + kind.text + "'");
  require(kind.number == 0 || kind.date == 0, at(std::max(kind.number, kind.date)),
          "either dates or numbers in one column");
}

}  // namespace

Eigen::Index CsvTable::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), file + ": column '" + name + "'", "one of " + join(names));
  return found - names.begin();
}

Eigen::Index CsvTable::missing(Eigen::Index column) const {
  return values.col(column).array().isNaN().count();
}

CsvTable readCsv(const std::string& file) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  CsvTable table;
  table.file = file;
  std::string line;
  std::getline(stream, line);
  if (line.rfind(kByteOrderMark, 0) == 0) line.erase(0, kByteOrderMark.size());
  require(!trimmed(line).empty(), file + ":1", "a header line");
  readHeader(line, table);
  std::vector<ColumnKind> kinds(table.names.size());
  const auto rows = readRows(stream, table, kinds);
  require(!rows.empty(), file, "at least one row below the header");
  table.values.resize(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(table.names.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < table.names.size(); ++c)
      table.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    checkColumn(table, table.names[c], kinds[c]);
    table.is_date.push_back(kinds[c].date != 0);
  }
  return table;
}

void writeCsv(const CsvTable& table, const std::string& file) {
  std::ofstream stream(file);
  require(stream.good(), file, "a writable file");
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string unit = i < table.units.size() ? table.units[i] : "";
    stream << (i ? "," : "") << table.names[i] << (unit.empty() ? "" : "[" + unit + "]");
  }
  stream << "\n";
  // A lone empty cell would be an empty line, which readers skip.
  const std::string missing = table.names.size() == 1 ? "nan" : "";
  for (Eigen::Index r = 0; r < table.values.rows(); ++r) {
    for (Eigen::Index c = 0; c < table.values.cols(); ++c) {
      const double value = table.values(r, c);
      stream << (c ? "," : "") << (std::isnan(value) ? missing : exactText(value));
    }
    stream << "\n";
  }
  stream.close();
  require(!stream.fail(), file, "room to write the whole table");
}

}  // namespace fpc
