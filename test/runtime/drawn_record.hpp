// The record of a drawn process as stage model of a commissioning has it, for tests and studies.
#pragma once

#include <algorithm>

#include "fmbpc/base/signals.hpp"
#include "identification/closed_loop_record.hpp"
#include "runtime/commissioning/process_models.hpp"

namespace fpc::test {

/// One input, one output, samples of 1 s.
inline PlantRecord plantRecord(const Data& d) {
  PlantInfo info;
  info.sample_time_s = 1.0;
  info.outputs = {{"y", "-", -1e3, 1e3}};
  info.inputs = {{"u", "-", -1e3, 1e3}};
  PlantRecord record(info);
  Measurement now;
  now.disturbances.resize(0);
  for (Index k = 0; k < d.y.size(); ++k) {
    now.outputs = d.y.segment(k, 1);
    now.input_applied = d.u.row(std::max<Index>(k - 1, 0)).transpose();
    record.add(now, d.u.row(k).transpose());
  }
  return record;
}

/// Elements and their ensemble, with a load, as lines and with the curve of the gain that they
/// find.
struct DrawnModels {
  ProcessModels straight, curved;
  bool hasCurve() const { return curved.fits.front().curve.has_value(); }
};
inline DrawnModels drawnModels(const PlantRecord& record, int members, std::uint64_t seed) {
  TsModel names;
  names.name = "drawn";
  names.sample_time_s = record.info().sample_time_s;
  names.outputs = record.info().outputs;
  names.inputs = record.info().inputs;
  ProcessFitParams params;
  params.ensemble = members;
  params.seed = seed;
  const Matrix u = record.inputsAndDisturbances();
  const Vector y = record.outputs().col(0);
  ProcessFit fit = fitProcess(u, y, names.sample_time_s, params);
  DrawnModels models;
  models.straight = modelsOf(names, {fit}, members, {true});
  fit.curve = gainCurve(fit, u, 1, y, names.sample_time_s, params);
  models.curved = modelsOf(names, {fit}, members, {true});
  return models;
}

}  // namespace fpc::test
