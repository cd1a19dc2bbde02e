// The header line of a table alone, for checks before the whole is read.
#pragma once

#include "base/csv.hpp"

namespace fpc {

/// File, names and units of the table, without rows. @throws InputError as readCsv() for them.
CsvTable readCsvHeader(const std::string& file, const CsvFormat& format = {});

}  // namespace fpc
