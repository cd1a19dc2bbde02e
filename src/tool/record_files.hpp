// Records and model files of the identification commands.
#pragma once

#include <string>

#include "base/csv.hpp"
#include "identification/data_set.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

CsvFormat csvFormat(const RecordFormat& format);
/// Rows "A:B" (empty: all) of a table; its source names the file without folders, so that
/// provenance does not depend on where the user's folders are.
DataSet makeData(const CsvTable& table, const Structure& structure, const std::string& rows);
/// The same with times made even; a record whose times jump back becomes several, joined. Remarks
/// say what was done.
DataSet makeJoinedData(const CsvTable& table, const Structure& structure, const std::string& rows,
                       std::vector<std::string>& remarks);
/// Refuses before hours of work what could not be written after it.
void checkTarget(const std::string& file);
/// True if both, "A:B" or empty, share a row.
bool rowsOverlap(const std::string& a, const std::string& b);

}  // namespace fpc::tool
