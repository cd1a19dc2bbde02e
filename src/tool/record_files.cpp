#include "tool/record_files.hpp"

#include <filesystem>

#include "fmbpc/base/input_error.hpp"

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
