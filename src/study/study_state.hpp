// The state file of a study. Private to the room.
#pragma once

#include <string>

#include "study/study.hpp"

namespace fpc {

/// A run in one line, exactly.
std::string textOf(const RunJudgement& run);
RunJudgement judgementOf(const std::string& text);

/// Written beside and renamed, so that a crash leaves the old one. @throws InputError.
void writeStudyState(const std::string& file, const std::string& fingerprint,
                     const std::vector<std::optional<RunJudgement>>& runs);
/// @throws InputError if it is not there, not a state, or of another study.
std::vector<std::optional<RunJudgement>> readStudyState(const std::string& file,
                                                        const std::string& fingerprint,
                                                        std::size_t runs);

}  // namespace fpc
