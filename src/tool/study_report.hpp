// A study in words and numbers. Private to the tool.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fmbpc/study/study_statistics.hpp"

namespace fpc::tool {

nlohmann::ordered_json toJson(const StudyPlan& plan, const StudyResult& result,
                              const StudyStatistics& statistics);
std::string toTable(const StudyPlan& plan, const StudyResult& result,
                    const StudyStatistics& statistics);
/// One line per run. @throws InputError if it cannot be written.
void writeRuns(const StudyPlan& plan, const StudyResult& result, const std::string& file);

}  // namespace fpc::tool
