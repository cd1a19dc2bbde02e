// The last word on an identified model: what rows that it never saw say.
#pragma once

#include "tool/judgement.hpp"

namespace fpc::tool {

/// By how much a model may err more than the linear one beside it on validation rows.
inline constexpr double kWorse = 1.05;

/// Where the chosen kind of an output runs freely more than kWorse times as far off as the linear
/// model on the validation rows, the next kind that does not is chosen, linear at last, and control
/// laws get linear if their model is worse; the verdict says so first. @return true if any changed.
bool chooseByValidation(const RecordJudgement& validation, AutoIdentification& found);

/// What of a judgement comes before all figures: outputs that a model predicts worse than the
/// linear model beside it or than the mean of the record; per output, in words; empty: nothing.
std::vector<std::string> warnings(const RecordJudgement& part);

/// Prediction intervals of the chosen kind that hold fewer values of a record than chance leaves of
/// 95 %, in words; empty: none does.
std::string coverageWords(const OutputJudgement& o);

/// The same at the end of the verdicts, of validation rows.
void tellCoverage(const RecordJudgement& validation, AutoIdentification& found);

/// --kind asks for other models than the best: the verdict says what was asked for.
void chooseByKind(ModelKind kind, AutoIdentification& found);

}  // namespace fpc::tool
