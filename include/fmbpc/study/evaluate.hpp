// The benchmark's own indices of a recorded run of BSM1: quality of the effluent, cost of
// operation, violations of the limits.
//
// Source: alex2008, chapter on performance assessment;
// the weights of copp2002 on request.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/csv.hpp"

namespace fpc {

struct EvaluateParams {
  double from_h{-1.0}, to_h{-1.0};  ///< judged part of the run; negative: its last seven days
  bool weights_2002{false};         ///< 20 S_NKj + 20 S_NO instead of 30 and 10, AE and PE as then
  void validate() const;            ///< @throws InputError naming the field
};

/// One effluent limit over the judged part.
struct LimitIndices {
  std::string name;
  double limit{};          ///< [g/m3]
  double share_percent{};  ///< of the samples above it
  int crossings{};         ///< times it was crossed upwards
  double percentile_95{};  ///< of the samples, nearest rank
  double mean{};           ///< weighted by the effluent flow
};

struct EffluentReport {
  std::uint64_t samples{};
  double days{};
  double EQI{}, IQI{};               ///< [kg pollution units/d]
  double AE{}, PE{}, ME{};           ///< aeration, pumping, mixing [kWh/d]
  double SP{};                       ///< sludge for disposal [kg/d]
  double EC{};                       ///< carbon dosed [kg COD/d]
  double OCI{};                      ///< AE + PE + 5 SP + 3 EC + ME
  std::vector<LimitIndices> limits;  ///< TN, COD, S_NH, TSS, BOD
  const LimitIndices& limit(const std::string& name) const;
};

/// @param trajectory of `run --out`, of plant bsm1, bsm1_pi or bsm1_air. Samples closer than 15
/// minutes are thinned to these. @throws InputError naming the missing column or the empty window.
EffluentReport evaluateEffluent(const CsvTable& trajectory, const EvaluateParams& params = {});

}  // namespace fpc
