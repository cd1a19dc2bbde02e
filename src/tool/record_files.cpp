#include "tool/record_files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "identification/auto_identify.hpp"
#include "tool/time_column.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

std::string rowsText(const std::string& text) { return text.empty() ? ":" : text; }

}  // namespace

CsvFormat csvFormat(const RecordFormat& format) {
  CsvFormat csv{separatorOf(format.separator), decimalOf(format.decimal), format.missing};
  csv.validate();
  return csv;
}

DataSet makeData(const CsvTable& table, const Structure& structure, const std::string& rows) {
  DataSet data = makeDataSet(table, structure, parseRows(rowsText(rows)));
  const std::string name = fs::path(table.file).filename().string();
  data.source.replace(0, table.file.size(), name);
  return data;
}

DataSet makeJoinedData(const CsvTable& table, const Structure& structure, const std::string& rows,
                       std::vector<std::string>& remarks) {
  std::vector<CsvTable> pieces = piecesOf(table, structure.time_column, remarks);
  if (pieces.size() == 1)
    return makeData(withEvenTimes(std::move(pieces.front()), structure.time_column, remarks),
                    structure, rows);
  const RowRange asked = parseRows(rowsText(rows));
  std::vector<DataSet> parts;
  Eigen::Index before = 0;
  for (auto& piece : pieces) {
    const Eigen::Index count = piece.rows(),
                       first = std::max(asked.first - before, Eigen::Index{1});
    const Eigen::Index last = asked.last == 0 ? count : std::min(asked.last - before, count);
    before += count;
    if (first > last) continue;
    parts.push_back(makeData(withEvenTimes(std::move(piece), structure.time_column, remarks),
                             structure, std::to_string(first) + ":" + std::to_string(last)));
    parts.back().source += " of piece " + std::to_string(parts.size());
  }
  require(!parts.empty(), table.file, "rows within 1:" + std::to_string(before) + ", got " + rows);
  return joinRecords(parts);
}

void checkTarget(const std::string& file) {
  if (file.empty()) return;
  const fs::path folder = fs::absolute(file).parent_path();
  require(fs::is_directory(folder), file, "a file in an existing folder");
  require(!fs::is_directory(file), file, "a file, not a folder");
}

bool rowsOverlap(const std::string& first, const std::string& second) {
  const RowRange a = parseRows(rowsText(first)), b = parseRows(rowsText(second));
  const auto before = [](RowRange x, RowRange y) { return x.last != 0 && x.last < y.first; };
  return !before(a, b) && !before(b, a);
}

}  // namespace fpc::tool
