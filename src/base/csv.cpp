#include "fmbpc/base/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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

/// Days since 1970-01-01 of a civil date (Hinnant 2013, days_from_civil).
std::optional<double> dayOf(const std::string& cell) {
  int y = 0, m = 0, d = 0, used = 0;
  if (std::sscanf(cell.c_str(), "%4d-%2d-%2d%n", &y, &m, &d, &used) != 3) return {};
  if (used != static_cast<int>(cell.size()) || m < 1 || m > 12 || d < 1 || d > 31) return {};
  y -= m <= 2;
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  return era * 146097.0 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719468;
}

std::optional<double> numberOf(const std::string& cell) {
  if (cell.empty()) return kMissing;
  double value = 0.0;
  const char* begin = cell.data() + (cell.front() == '+');
  const auto result = std::from_chars(begin, cell.data() + cell.size(), value);
  if (result.ec == std::errc{} && result.ptr == cell.data() + cell.size()) return value;
  return dayOf(cell);
}

void readHeader(const std::string& line, CsvTable& table) {
  std::set<std::string> seen;
  for (const auto& cell : cellsOf(line)) {
    const auto open = cell.find('[');
    const bool has_unit = open != std::string::npos && cell.back() == ']';
    table.names.push_back(trimmed(has_unit ? cell.substr(0, open) : cell));
    table.units.push_back(has_unit ? cell.substr(open + 1, cell.size() - open - 2) : "");
    require(!table.names.back().empty(), table.file + ":1", "a name for every column");
    require(seen.insert(table.names.back()).second, table.file + ":1: column '" + table.names.back() + "'",
            "every column name only once");
  }
}

struct BadCell {
  std::size_t line{};
  std::string text;
};

/// Reads the rows below the header; remembers the first cell per column that is no number.
std::vector<std::vector<double>> readRows(std::istream& stream, const CsvTable& table, std::vector<BadCell>& bad) {
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    if (trimmed(line).empty()) continue;
    const auto cells = cellsOf(line);
    const std::string at = table.file + ":" + std::to_string(number);
    require(cells.size() == table.names.size(), at,
            std::to_string(table.names.size()) + " cells, got " + std::to_string(cells.size()));
    std::vector<double> row(cells.size(), kMissing);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = numberOf(cells[i]);
      if (value) row[i] = *value;
      else if (bad[i].line == 0) bad[i] = {number, cells[i]};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void checkBadCells(const CsvTable& table, const std::vector<BadCell>& bad) {
  for (std::size_t i = 0; i < bad.size(); ++i) {
    if (bad[i].line == 0) continue;
    const auto column = table.values.col(static_cast<Eigen::Index>(i));
    const bool has_numbers = (column.array() == column.array()).any();
    require(!has_numbers, table.file + ":" + std::to_string(bad[i].line) + ": column '" + table.names[i] + "'",
            "a number, got '" + bad[i].text + "'");
  }
}

}  // namespace

Eigen::Index CsvTable::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), file + ": column '" + name + "'", "one of " + join(names));
  return found - names.begin();
}

CsvTable readCsv(const std::string& file) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  CsvTable table;
  table.file = file;
  std::string line;
  require(static_cast<bool>(std::getline(stream, line)) && !trimmed(line).empty(), file + ":1", "a header line");
  readHeader(line, table);
  std::vector<BadCell> bad(table.names.size());
  const auto rows = readRows(stream, table, bad);
  require(!rows.empty(), file, "at least one row below the header");
  table.values.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(table.names.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < table.names.size(); ++c)
      table.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  checkBadCells(table, bad);
  return table;
}

void writeCsv(const CsvTable& table, const std::string& file) {
  std::ofstream stream(file);
  require(stream.good(), file, "a writable file");
  for (std::size_t i = 0; i < table.names.size(); ++i)
    stream << (i ? "," : "") << table.names[i] << (table.units[i].empty() ? "" : "[" + table.units[i] + "]");
  stream << "\n";
  for (Eigen::Index r = 0; r < table.values.rows(); ++r) {
    for (Eigen::Index c = 0; c < table.values.cols(); ++c) {
      const double value = table.values(r, c);
      stream << (c ? "," : "") << (std::isnan(value) ? "" : exactText(value));
    }
    stream << "\n";
  }
  stream.close();
  require(!stream.fail(), file, "room to write the whole table");
}

}  // namespace fpc
