// The benchmark's own indices of a recorded run of BSM1: quality of the effluent, cost of
// operation, violations of the limits.
//
// Source: alex2008, chapter on performance assessment;
// the weights of copp2002 on request.
#pragma once

#include <string>
#include <vector>

#include "base/csv.hpp"

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
  double percentile_95{};  ///< of the samples, as prctile: (i - 0.5)/n, joined linearly
  double mean{};           ///< weighted by the effluent flow
};

/// What was moved in the judged part. Runs of different levers are not to be compared.
enum class Levers {
  kClassA,         ///< Qr and Qw as in the benchmark, no carbon, KLa at most 240 1/d
  kLargerBlowers,  ///< the same with more than 240 1/d
  kClassB          ///< another Qr, Qw, or carbon
};
std::string wordOf(Levers levers);  ///< "A", "A, KLa > 240", "B"

struct EffluentReport {
  std::uint64_t samples{};
  double sample_min{};  ///< spacing of the judged samples [min]; the benchmark's: 15
  double days{};        ///< judged; the benchmark's: 7
  Levers levers{Levers::kClassA};
  double EQI{}, IQI{};               ///< [kg pollution units/d]
  double AE{}, PE{}, ME{};           ///< aeration, pumping, mixing [kWh/d]
  double SP{};                       ///< sludge for disposal [kg/d]
  double EC{};                       ///< carbon dosed [kg COD/d]
  double OCI{};                      ///< AE + PE + 5 SP + 3 EC + ME
  std::vector<LimitIndices> limits;  ///< TN, COD, S_NH, TSS, BOD
  const LimitIndices& limit(const std::string& name) const;
};

/// @param trajectory of `run --out`, of plant bsm1, bsm1_pi or bsm1_air. Samples closer than 15
/// minutes are thinned to these. Times in the unit of their header, hours if it has none.
/// @throws InputError naming the missing column, one of another unit, a missing cell or a hole in
/// the judged part, or the empty window.
EffluentReport evaluateEffluent(const CsvTable& trajectory, const EvaluateParams& params = {});

}  // namespace fpc
