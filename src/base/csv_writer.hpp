// A table written row by row, as writeCsv() writes a whole one.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace fpc {

class CsvWriter {
 public:
  explicit CsvWriter(const std::string& file);  ///< @throws InputError if it cannot be written
  /// Names with their units in brackets; a name without a unit has none.
  void header(const std::vector<std::string>& names, const std::vector<std::string>& units);
  void row(const std::vector<double>& cells);  ///< NaN is an empty cell
  void close();                                ///< @throws InputError if there was no room

 private:
  std::string file_;
  std::ofstream stream_;
};

}  // namespace fpc
