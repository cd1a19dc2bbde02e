// Tables read by parts: the header line alone, for checks before the whole is read, or no header.
#pragma once

#include "base/csv.hpp"

namespace fpc {

/// File, names and units of the table, without rows. @throws InputError as readCsv() for them.
CsvTable readCsvHeader(const std::string& file, const CsvFormat& format = {});

/// readCsv() of a file whose first line holds values: its columns are called 1, 2, ..
CsvTable readCsvWithoutHeader(const std::string& file, const CsvFormat& format = {});

}  // namespace fpc
