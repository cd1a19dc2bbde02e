// A record of a process for identification: a CSV, or a bag where the tool is built with ROS.
#pragma once

#include <string>

#include "base/csv.hpp"

namespace fpc::tool {

/// Bags are told by their content, whatever their name.
/// @throws InputError naming the file.
CsvTable readRecord(const std::string& file, const CsvFormat& format, bool header = true);

}  // namespace fpc::tool
