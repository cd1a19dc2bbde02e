// One record, identified and judged: the first rows give the model, the last ones, held out, say
// what it is worth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/identify.hpp"
#include "identification/validation.hpp"

namespace fpc {

/// Where it is; `validation` grows as outputs are judged.
struct RecordProgress {
  IdentifyProgress identify;
  std::vector<OutputValidation> validation;
};
/// May be empty; false cancels.
using RecordCallback = std::function<bool(const RecordProgress&)>;

struct RecordIdentification {
  Identification found;
  std::vector<OutputValidation>
      validation;  ///< of the held-out rows, or of all if none are held out
  bool held_out{};
  Eigen::Index rows{};
  bool cancelled{};  ///< nothing else is to be used then
};

/// Identifies from all but the last `share` of the rows and validates on those. `values` has the
/// structure's signals in its order (see SampleCollector::rows). Missing cells are stepped over
/// whatever the structure says: a plant that runs does lose samples. @param share of the rows that
/// is held out, 0 <= share < 1; with 0 the model is validated on the rows it comes from. @throws
/// InputError as makeDataSet(), identify(), or naming the share.
RecordIdentification identifyRecord(const Matrix& values, Structure structure,
                                    const std::string& source, double share,
                                    const RecordCallback& callback = {});

}  // namespace fpc
