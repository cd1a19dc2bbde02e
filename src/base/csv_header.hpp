// The names and units of a table without its rows. Private to the core.
#pragma once

#include <istream>
#include <string>

#include "fmbpc/base/csv.hpp"

namespace fpc {

/// File, names and units; the stream is left before the first row. @throws InputError as readCsv().
CsvTable readCsvHeader(std::istream& stream, const std::string& file, const CsvFormat& format);

}  // namespace fpc
