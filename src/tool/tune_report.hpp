// What `fmbpc tune` prints and writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "study/tune.hpp"

namespace fpc::tool {

/// A tuning and its score on the held-out scenarios (empty if there are none or it was stopped).
struct TunedLoop {
  std::string loop;  ///< as asked for
  TuneResult result;
  std::optional<TuningScore> held_out;
};

/// "lower" or "upper" if the value stands at that bound of its range (to a thousandth of it).
std::string boundOf(const TuningParameter& parameter, double value);
/// What the untouched loop has, if it lies outside the range.
bool isOutside(const TuningParameter& parameter, double own);
/// That the tuned loop costs more than the untouched one, on the held-out scenarios or, without
/// them, on those that it was tuned on; in words, empty if it does not.
std::string worsening(const TuningObjective& objective, const TunedLoop& tuned);
/// That every point of the search cost the same, or the most that a run can cost; in words, empty
/// if some point was better than another.
std::string nothingFound(const TuningObjective& objective, const TuneResult& result);
/// nothingFound(), else worsening(): what is said first.
std::string verdictOf(const TuningObjective& objective, const TunedLoop& tuned);
inline constexpr int kTunedWorse = 3;  ///< exit code of a tuning with such a verdict
/// Parameters that stand at a bound or began outside their range, costs that got worse; a line
/// each.
std::vector<std::string> remarksOf(const TuningObjective& objective, const TunedLoop& tuned);

/// Infinite numbers are null.
OrderedJson toJson(const TuningObjective& objective, const TunedLoop& tuned);
std::string toTable(const TuningObjective& objective, const TunedLoop& tuned);
/// LOOP_tuned.yaml: extends the loop. Returns the file's name.
std::string writeTunedLoop(const TuningObjective& objective, const TunedLoop& tuned,
                           const std::string& folder);

struct CompareOptions {
  std::string loop;
  SearchParams search;  ///< method is replaced, seeds count up from its seed
  std::vector<std::string> methods;
  int seeds{6};
  std::string out;
  bool resume{false};
};
/// Every method with every seed. Prints nothing; state files in `out`. Stopped: `complete` false.
OrderedJson compareMethods(const TuningObjective& objective, const CompareOptions& options);
std::string comparisonTable(const OrderedJson& comparison);

}  // namespace fpc::tool
