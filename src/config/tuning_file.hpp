// A tuning file read into structs: which numbers of a loop may change, what a good run is, on which
// scenarios. All keys: docs/tuning_file.md.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "config/variation.hpp"
#include "optim/population_search.hpp"

namespace fpc {

/// One number of the loop file.
struct TuningParameter {
  std::string key;  ///< path as --set takes it: controller.loops.0.kp
  double lower{}, upper{};
  bool logarithmic{false};
  bool integer{false};
  double start{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: that of the loop
  /// 0..1 to lower..upper, and back (clamped).
  double value(double share) const;
  double share(double value) const;
};

/// weight times an index of performance.
struct FitnessTerm {
  std::string index;   ///< one of fitnessIndices()
  std::string signal;  ///< output, input or name of a consumption; empty: all of them
  double weight{1.0};
  double above{-std::numeric_limits<double>::infinity()};  ///< only what exceeds this counts
  std::string scenario;  ///< counts in this one alone; empty: in all
};

/// What becomes of the costs of several scenarios.
enum class AcrossScenarios { kMean, kMedian, kWorst };
inline std::vector<std::string> wordsOf(AcrossScenarios) { return {"mean", "median", "worst"}; }

struct FitnessParams {
  std::vector<FitnessTerm> terms;
  double band{0.02};           ///< of a step, for settling
  std::string time_unit{"h"};  ///< of rise and settling: s, min, h
  AcrossScenarios across{AcrossScenarios::kMean};
  bool relative{false};  ///< each scenario's cost divided by that of the untouched loop
  double failure{std::numeric_limits<double>::infinity()};  ///< cost of a run that fails; also the
                                                            ///< largest cost of any run
};

/// The loop as it is asked for once.
struct TuningScenario {
  std::string name;
  std::string loop;  ///< another loop file; empty: the one that is tuned
  Overrides set;
  bool has_seed{false};
  std::uint64_t seed{};  ///< of the run (key `seed`) and of `vary`
  std::vector<Variation> vary;
};

struct TuningFile {
  std::string file;
  std::string title;
  std::string text;  ///< as read
  Overrides set;     ///< laid over the loop in every scenario, and kept in the tuned loop
  std::vector<TuningParameter> parameters;
  FitnessParams fitness;
  std::vector<TuningScenario> scenarios;  ///< at least one
  std::vector<TuningScenario> held_out;   ///< judged before and after, never tuned on
  SearchParams search;
};

/// A tuning file from its name ("column") in config/tuning, or path. @throws InputError listing the
/// known names.
std::string findTuning(const std::string& name_or_path);
std::vector<std::string> tuningNames();
/// @throws InputError naming file, line, key and what was expected.
TuningFile readTuning(const std::string& name_or_path);
TuningFile parseTuning(const std::string& text, const std::string& file);

}  // namespace fpc
