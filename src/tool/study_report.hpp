// A study in words and numbers. Private to the tool.
#pragma once

#include <string>

#include "base/ordered_json.hpp"
#include "study/study_statistics.hpp"

namespace fpc::tool {

struct StudyArguments;
/// The study that the arguments name, or the one that they describe. @throws InputError.
StudyFile studyOf(const StudyArguments& arguments);
OrderedJson toJson(const StudyPlan& plan, const StudyResult& result,
                   const StudyStatistics& statistics);
std::string toTable(const StudyPlan& plan, const StudyResult& result,
                    const StudyStatistics& statistics);
/// One line per run. @throws InputError if it cannot be written.
void writeRuns(const StudyPlan& plan, const StudyResult& result, const std::string& file);

}  // namespace fpc::tool
