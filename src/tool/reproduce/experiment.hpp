// The registry of `fmbpc reproduce`: one file a system, one line an experiment.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fpc::tool {

enum class Verdict { kReproduced, kClose, kNotReproducible, kBetter };
const char* name(Verdict verdict);

struct ReproduceRow {
  std::string quantity;
  double paper{};  ///< NaN: the paper prints no number
  double here{};   ///< NaN: nothing to compute
  std::string unit;
  Verdict verdict{};
  std::string note;  ///< the reason, or within what it agrees
};

struct Experiment {
  std::string name;
  std::string source;
  std::function<std::vector<ReproduceRow>()> rows;  ///< computed when asked, nothing is stored
};

bool registerExperiment(Experiment experiment);
std::vector<Experiment> experiments();  ///< by name

/// reproduced within 1 %, close within `close`, else not reproducible with the reason.
ReproduceRow compare(const std::string& quantity, double paper, double here,
                     const std::string& unit, double close = 0.1, const std::string& reason = "");
/// A number without a counterpart: the verdict is the caller's.
ReproduceRow state(const std::string& quantity, double here, const std::string& unit,
                   Verdict verdict, const std::string& note);
ReproduceRow outOfReach(const std::string& quantity, double paper, const std::string& unit,
                        const std::string& reason);

}  // namespace fpc::tool
