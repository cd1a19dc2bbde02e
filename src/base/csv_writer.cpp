#include "base/csv_writer.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {

namespace {

/// As readers take it back: quoted if it holds what separates cells.
std::string headerCell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

CsvWriter::CsvWriter(const std::string& file) : file_(file), stream_(file) {
  require(stream_.good(), file, "a writable file");
}

void CsvWriter::header(const std::vector<std::string>& names,
                       const std::vector<std::string>& units) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string unit = i < units.size() ? units[i] : "";
    stream_ << (i ? "," : "") << headerCell(names[i] + (unit.empty() ? "" : "[" + unit + "]"));
  }
  stream_ << "\n";
}

void CsvWriter::row(const std::vector<double>& cells) {
  // A lone empty cell would be an empty line, which readers skip.
  const char* missing = cells.size() == 1 ? "nan" : "";
  for (std::size_t c = 0; c < cells.size(); ++c)
    stream_ << (c ? "," : "") << (std::isnan(cells[c]) ? missing : exactText(cells[c]));
  stream_ << "\n";
}

void CsvWriter::close() {
  stream_.close();
  require(!stream_.fail(), file_, "room to write the whole table");
}

}  // namespace fpc
