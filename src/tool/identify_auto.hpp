// `fmbpc identify`, without files and printing as well.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/identified_file.hpp"
#include "tool/commands.hpp"
#include "tool/identify_report.hpp"
#include "tool/judgement.hpp"

namespace fpc::tool {

/// What is identified from.
struct IdentifyTables {
  std::vector<CsvTable> data;
  std::optional<CsvTable> validation;  ///< absent: the first of `data`, if rows of it are named
  bool validate_all{false};            ///< on all rows of that
};
/// The files that the arguments name. @throws InputError naming the file.
IdentifyTables readTables(const IdentifyArguments& arguments, const CsvFormat& format);

struct AutoReport {
  AutoIdentification found;
  IdentifiedModel model;
  std::vector<RecordJudgement> parts;  ///< identification first
  std::vector<std::string> remarks;
  std::string source;
  double seconds{};
  OrderedJson json;
};
/// Searches a structure for outputs, inputs and disturbances that the arguments name.
/// @throws InputError naming record and column.
AutoReport searchModel(IdentifyArguments arguments, const IdentifyTables& tables,
                       const AutoCallback& progress);
/// Identifies with the structure that the arguments name.
IdentifyReport identifyWith(const IdentifyArguments& arguments, const IdentifyTables& tables,
                            const IdentifyCallback& progress);

int identifyStructure(const IdentifyArguments& arguments);  ///< with a structure file
int identifyAuto(const IdentifyArguments& arguments);

}  // namespace fpc::tool
