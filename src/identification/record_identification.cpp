#include "identification/record_identification.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kIdentifyShare = 0.95;  // of the progress shown

/// False cancels.
bool tell(const RecordCallback& callback, const RecordProgress& progress) {
  return !callback || callback(progress);
}

}  // namespace

RecordIdentification identifyRecord(const Matrix& values, Structure structure,
                                    const std::string& source, double share,
                                    const RecordCallback& callback) {
  require(share >= 0.0 && share < 1.0, "validation_share", "0 <= share < 1");
  if (structure.repair.missing == MissingCells::kError)
    structure.repair.missing = MissingCells::kDrop;
  const auto held_out =
      static_cast<Eigen::Index>(std::floor(share * static_cast<double>(values.rows())));
  RecordIdentification result;
  result.held_out = held_out > 0;
  result.rows = values.rows();
  RecordProgress progress;
  progress.identify.stage = "reading";
  progress.identify.samples = values.rows();
  result.cancelled = !tell(callback, progress);
  if (result.cancelled) return result;

  const DataSet data = makeDataSet(values.topRows(values.rows() - held_out), structure, source);
  result.found = identify(data, structure, [&](const IdentifyProgress& now) {
    progress.identify = now;
    progress.identify.share *= kIdentifyShare;
    return tell(callback, progress);
  });
  result.cancelled = result.found.cancelled;
  if (result.cancelled) return result;

  progress.identify.stage = "validation";
  progress.identify.output.clear();
  progress.identify.share = kIdentifyShare;
  result.cancelled = !tell(callback, progress);
  if (result.cancelled) return result;
  DataSet judged = data;
  if (result.held_out) {
    structure.repair.drop_constant =
        true;  // the model has what it needs; a quiet input is no obstacle to a judgement
    judged = makeDataSet(values.bottomRows(held_out), structure, source + ", held out");
  }
  result.validation =
      validateModel(result.found.model, result.found.linear, judged, structure.validation);
  progress.validation = result.validation;
  progress.identify.share = 1.0;
  progress.identify.stage = "done";
  result.cancelled = !tell(callback, progress);
  return result;
}

}  // namespace fpc
