// What `fmbpc identify` found, as one JSON object and as tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/identify.hpp"
#include "identification/validation.hpp"

namespace fpc::tool {

/// One set of rows and what the models make of it.
struct JudgedRecord {
  std::string title;  ///< "identification", "validation"
  DataSet data;
  std::vector<OutputValidation> outputs;
};

struct IdentifyReport {
  Identification found;
  JudgedRecord identification;
  std::optional<JudgedRecord> validation;  ///< absent: nothing was held out
  std::vector<std::string> remarks;
  double seconds{};  ///< wall time of identification
};

/// Keys: docs/structure_file.md. Numbers that are not finite, and figures of no sample, are null.
std::string toJson(const IdentifyReport& report);
std::string toTables(const IdentifyReport& report);

}  // namespace fpc::tool
