// The folder that fmbpc.plots draws from.
#pragma once

#include <string>

#include "base/ordered_json.hpp"
#include "tool/identify_report.hpp"

namespace fpc::tool {

/// Writes report.json (figures, membership functions, residual correlations), identification.csv
/// and validation.csv (measured outputs and predictions) and draws memberships.png, prediction.png
/// and residuals.png. No picture is a warning on standard error, not a failure.
/// @throws InputError if the folder cannot be written.
void writeModelPlots(const IdentifyReport& report, const std::string& folder);

/// The same of a model alone: memberships.png and steps.png.
void plotModel(const TsModel& model, const std::string& folder);

/// Adds what is drawn of a model beside a record: its sets, its points (pointsJson()), the names of
/// its inputs and disturbances.
void addModelJson(const TsModel& model, OrderedJson& json);

/// The columns of inputs and disturbances of `data` behind those of a table of predictions.
void addCauses(const DataSet& data, CsvTable& table);

/// Per output, per antecedent: the degrees of all rules over the range of the data.
OrderedJson membershipsJson(const TsModel& model);

}  // namespace fpc::tool
