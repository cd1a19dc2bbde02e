#include "base/csv.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "base/csv_cell.hpp"
#include "base/csv_header.hpp"
#include "base/csv_writer.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

const std::string kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets put it before UTF-8

const std::map<std::string, char>& separators() {
  static const std::map<std::string, char> words = {
      {",", ','},     {";", ';'},         {"|", '|'},   {"\t", '\t'},
      {"comma", ','}, {"semicolon", ';'}, {"bar", '|'}, {"tab", '\t'}};
  return words;
}

const std::map<std::string, char>& decimals() {
  static const std::map<std::string, char> words = {
      {".", '.'}, {",", ','}, {"point", '.'}, {"comma", ','}};
  return words;
}

std::string wordOf(char separator) {
  for (const auto& [word, c] : separators())
    if (c == separator && word.size() > 1) return word;
  return {separator};
}

bool isBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

/// Bytes that no table has, said before they cut a cell or fill a message.
void requireText(const std::string& line, const std::string& file, std::size_t number) {
  const auto expected = [&](const char* words) {
    throw InputError(file + ":" + std::to_string(number) + ": expected " + words);
  };
  if (line.rfind("\xFF\xFE", 0) == 0 || line.rfind("\xFE\xFF", 0) == 0)
    expected("text in UTF-8, got UTF-16 (save it as UTF-8)");
  if (line.find('\0') != std::string::npos)
    expected("text in UTF-8, got a NUL byte (UTF-16? a file that is no text?)");
  const auto alone = line.find('\r');
  if (alone != std::string::npos && line.find_first_not_of(" \t\r", alone) != std::string::npos)
    expected("lines that end in LF or CR LF, got CR alone (save it with other line ends)");
}

/// The separator that this header line seems to have, if it is another one than said.
std::string otherSeparator(const std::string& line, char said) {
  for (const char c : {';', '\t', '|', ','})
    if (c != said && line.find(c) != std::string::npos)
      return " (separator: " + wordOf(said) + "; is it " + wordOf(c) + "?)";
  return "";
}

/// True if every cell is a number or a date: a row of values, not of names. Whole numbers 1, 2, ..
/// are names.
bool isRowOfValues(const std::vector<std::string>& cells, const CsvFormat& format) {
  bool counts = true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cellNumber(cells[i], format) && !cellTime(cells[i])) return false;
    counts = counts && cells[i] == std::to_string(i + 1);
  }
  return !counts;
}

void readHeader(const std::string& line, const CsvFormat& format, CsvTable& table) {
  const auto cells = cellsOf(line, format.separator);
  require(!isRowOfValues(cells, format), table.file + ":1",
          "a header line with a name for every column, got values (--no-header calls the "
          "columns 1, 2, ..)");
  std::set<std::string> seen;
  for (const auto& cell : cells) {
    const auto open = cell.find('[');
    const bool has_unit = open != std::string::npos && cell.back() == ']';
    std::string name = has_unit ? cell.substr(0, open) : cell;
    name.erase(name.find_last_not_of(' ') + 1);
    table.names.push_back(name);
    table.units.push_back(has_unit ? cell.substr(open + 1, cell.size() - open - 2) : "");
    require(!table.names.back().empty(), table.file + ":1", "a name for every column");
    require(seen.insert(table.names.back()).second,
            table.file + ":1: column '" + table.names.back() + "'", "every column name only once");
  }
}

/// The table without rows; the stream stands behind the header then, or at the begin of a file
/// without one.
CsvTable headerOf(std::istream& stream, const std::string& file, const CsvFormat& format,
                  bool header = true) {
  format.validate();
  require(stream.good(), file, "a readable file");
  CsvTable table;
  table.file = file;
  std::string line;
  std::getline(stream, line);
  if (line.rfind(kByteOrderMark, 0) == 0) line.erase(0, kByteOrderMark.size());
  requireText(line, file, 1);
  require(!isBlank(line), file + ":1", header ? "a header line" : "a row of values");
  if (header) {
    readHeader(line, format, table);
    return table;
  }
  table.units.resize(cellsOf(line, format.separator).size());
  for (std::size_t i = 1; i <= table.units.size(); ++i) table.names.push_back(std::to_string(i));
  stream.clear();
  stream.seekg(0);
  return table;
}

/// What a column has been seen to hold: the line of the first cell of each kind, 0 if there is
/// none.
struct ColumnKind {
  std::size_t number{}, date{}, zoned{}, local{}, other{};
  std::string text;  ///< of the first other cell
};

void keepFirst(std::size_t& first, std::size_t line) {
  if (first == 0) first = line;
}

double readCell(const std::string& cell, std::size_t line, const CsvFormat& format,
                ColumnKind& kind) {
  if (const auto value = cellNumber(cell, format)) {
    if (!std::isnan(*value)) keepFirst(kind.number, line);
    return *value;
  }
  if (const auto time = cellTime(cell)) {
    keepFirst(kind.date, line);
    keepFirst(time->zoned ? kind.zoned : kind.local, line);
    return time->days;
  }
  if (kind.other == 0) kind.text = cell;
  keepFirst(kind.other, line);
  return kNaN;
}

std::vector<std::vector<double>> readRows(std::istream& stream, const CsvFormat& format,
                                          CsvTable& table, std::vector<ColumnKind>& kinds,
                                          std::size_t first_line) {
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::size_t number = first_line; std::getline(stream, line); ++number) {
    if (number == 1 && line.rfind(kByteOrderMark, 0) == 0) line.erase(0, kByteOrderMark.size());
    requireText(line, table.file, number);
    if (isBlank(line)) continue;
    const auto cells = cellsOf(line, format.separator);
    const std::string hint = format.separator == ',' && line.find(';') != std::string::npos
                                 ? otherSeparator(line, format.separator)
                                 : "";
    require(
        cells.size() == table.names.size(), table.file + ":" + std::to_string(number),
        std::to_string(table.names.size()) + " cells, got " + std::to_string(cells.size()) + hint);
    std::vector<double> row(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      row[i] = readCell(cells[i], number, format, kinds[i]);
    rows.push_back(std::move(row));
    table.lines.push_back(number);
  }
  return rows;
}

void checkColumn(const CsvTable& table, const CsvFormat& format, const std::string& name,
                 const ColumnKind& kind) {
  const auto at = [&](std::size_t line) {
    return table.file + ":" + std::to_string(line) + ": column '" + name + "'";
  };
  const bool has_values = kind.number != 0 || kind.date != 0;
  require(kind.other == 0 || !has_values, at(kind.other),
          (kind.number != 0
               ? "a finite number, or a text that is said to mean missing (missing_values, "
                 "--missing), got '"
               : "a date or time of ISO 8601, or DD.MM.YYYY, got '") +
              kind.text + "'" + decimalHint(kind.text, format.decimal));
  require(kind.number == 0 || kind.date == 0, at(std::max(kind.number, kind.date)),
          "either dates or numbers in one column");
  require(kind.zoned == 0 || kind.local == 0, at(std::max(kind.zoned, kind.local)),
          "times all with a zone (Z, +hh:mm) or all without");
}

}  // namespace

char separatorOf(const std::string& word) {
  const auto found = separators().find(word);
  require(found != separators().end(), "separator",
          "one of comma, semicolon, tab, bar, got '" + word + "'");
  return found->second;
}

char decimalOf(const std::string& word) {
  const auto found = decimals().find(word);
  require(found != decimals().end(), "decimal", "point or comma, got '" + word + "'");
  return found->second;
}

void CsvFormat::validate() const {
  require(decimal == '.' || decimal == ',', "decimal", ". or ,");
  require(separator != decimal, "decimal", "another character than the separator");
}

Eigen::Index CsvTable::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  const std::string hint = names.size() == 1 ? otherSeparator(names.front(), ',') : "";
  require(found != names.end(), file + ": column '" + name + "'", "one of " + join(names) + hint);
  return found - names.begin();
}

Eigen::Index CsvTable::missing(Eigen::Index column) const {
  return values.col(column).array().isNaN().count();
}

std::string CsvTable::at(Eigen::Index row, Eigen::Index column) const {
  const auto r = static_cast<std::size_t>(row);
  const std::string place =
      r < lines.size() ? ":" + std::to_string(lines[r]) : ", row " + std::to_string(row + 1);
  return file + place + ": column '" + names[static_cast<std::size_t>(column)] + "'";
}

CsvTable readCsvHeader(const std::string& file, const CsvFormat& format) {
  std::ifstream stream(file);
  return headerOf(stream, file, format);
}

namespace {

CsvTable readTable(const std::string& file, const CsvFormat& format, bool header) {
  std::ifstream stream(file);
  CsvTable table = headerOf(stream, file, format, header);
  std::vector<ColumnKind> kinds(table.names.size());
  const auto rows = readRows(stream, format, table, kinds, header ? 2 : 1);
  require(!rows.empty(), file, "at least one row below the header");
  table.values.resize(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(table.names.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < table.names.size(); ++c)
      table.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    checkColumn(table, format, table.names[c], kinds[c]);
    table.is_date.push_back(kinds[c].date != 0);
    table.texts.push_back(kinds[c].text);
  }
  return table;
}

}  // namespace

CsvTable readCsv(const std::string& file, const CsvFormat& format) {
  return readTable(file, format, true);
}

CsvTable readCsvWithoutHeader(const std::string& file, const CsvFormat& format) {
  return readTable(file, format, false);
}

void writeCsv(const CsvTable& table, const std::string& file) {
  CsvWriter writer(file);
  writer.header(table.names, table.units);
  std::vector<double> cells(static_cast<std::size_t>(table.values.cols()));
  for (Eigen::Index r = 0; r < table.values.rows(); ++r) {
    for (std::size_t c = 0; c < cells.size(); ++c)
      cells[c] = table.values(r, static_cast<Eigen::Index>(c));
    writer.row(cells);
  }
  writer.close();
}

}  // namespace fpc
