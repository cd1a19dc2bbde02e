// The benchmark simulation model no. 1 under its baseline and under ours: what is claimed of class
// A (Qr, Qw and blowers as in the benchmark), of larger blowers, of class B (less sludge wasted),
// with noise and on an influent that nothing was tuned on. Classes are never mixed.
#include <map>

#include "fmbpc/loop/report.hpp"
#include "fmbpc/loop/run.hpp"
#include "fmbpc/study/evaluate.hpp"
#include "tool/reproduce/experiment.hpp"

namespace fpc::tool {
namespace {

EffluentReport evaluated(const std::string& name, const Overrides& overrides = {}) {
  const LoopFile loop = readLoop(name, overrides);
  return evaluateEffluent(trajectoryOf(loop, runLoop(loop)));
}

/// What a loop must reach beside the default control on the same influent.
struct Claim {
  std::string loop, beside;
  double EQI;     ///< at least so many percent below
  double OCI;     ///< at most so many percent above
  double TN, NH;  ///< at most so many percent of the time above the limits
};

void compare(const Claim& claim, const EffluentReport& is, Rows& rows) {
  const EffluentReport ours = evaluated(claim.loop);
  const std::string of = claim.loop + ", ";
  rows.push_back(check(of + "EQI below the default's", 100.0 * (1.0 - ours.EQI / is.EQI),
                       Direction::kHigher, claim.EQI, "%", "ours"));
  rows.push_back(check(of + "OCI over the default's", 100.0 * (ours.OCI / is.OCI - 1.0),
                       Direction::kLower, claim.OCI, "%", "ours"));
  rows.push_back(check(of + "time above TN 18", ours.limit("TN").share_percent, Direction::kLower,
                       claim.TN, "%", "ours"));
  rows.push_back(check(of + "time above NH 4", ours.limit("NH").share_percent, Direction::kLower,
                       claim.NH, "%", "ours"));
  rows.push_back(check(of + "time above TSS 30", ours.limit("TSS").share_percent, Direction::kLower,
                       0.0, "%", "ours"));
}

/// Each loop beside the default control named; that runs once.
Rows compared(const std::vector<Claim>& claims, const Overrides& of_default = {}) {
  Rows rows;
  std::map<std::string, EffluentReport> defaults;
  for (const Claim& claim : claims) {
    auto found = defaults.find(claim.beside);
    if (found == defaults.end())
      found = defaults.emplace(claim.beside, evaluated(claim.beside, of_default)).first;
    compare(claim, found->second, rows);
  }
  return rows;
}

const std::string kDry = "bsm1_default", kRain = "bsm1_default_rain";

Rows baseline() {
  Rows rows;
  const struct {
    const char* loop;
    double EQI, OCI, TN, NH;
  } known[] = {{"bsm1_supervisor", 5851.0, 16256.0, 5.1, 17.4},
               {"bsm1_supervisor_rain", 8110.0, 15992.0, 2.7, 22.6}};
  const Judged share{0.0, Direction::kEqual, 0.6};
  for (const auto& is : known) {
    const EffluentReport r = evaluated(is.loop);
    const std::string of = is.loop + std::string(", ");
    rows.push_back(figure(of + "EQI", is.EQI, r.EQI, "kg/d", {0.003}));
    rows.push_back(figure(of + "OCI", is.OCI, r.OCI, "-", {0.003}));
    rows.push_back(figure(of + "time above TN 18", is.TN, r.limit("TN").share_percent, "%", share));
    rows.push_back(figure(of + "time above NH 4", is.NH, r.limit("NH").share_percent, "%", share));
  }
  return rows;
}

Rows classA() {
  return compared({{"bsm1_fmbpc", kDry, 3.0, 0.0, 12.0, 16.0},
                   {"bsm1_fmbpc_rain", kRain, 2.3, 0.0, 6.5, 23.0},
                   {"bsm1_fmbpc_clp", kDry, 3.0, 0.0, 12.0, 16.0},
                   {"bsm1_fmbpc_clp_rain", kRain, 2.3, 0.0, 6.5, 23.0}});
}

/// Past the baseline.
Rows aim() {
  return compared({{"bsm1_fmbpc", kDry, 4.5, 0.0, 12.0, 16.0},
                   {"bsm1_fmbpc_rain", kRain, 3.0, 0.0, 6.5, 23.0},
                   {"bsm1_fmbpc_clp", kDry, 4.5, 0.0, 12.0, 16.0},
                   {"bsm1_fmbpc_clp_rain", kRain, 3.0, 0.0, 6.5, 23.0}});
}

/// The same tuning with one rule.
Rows linearTwin() {
  Rows rows;
  for (const char* influent : {"", "_rain"}) {
    const EffluentReport fuzzy = evaluated(std::string("bsm1_fmbpc") + influent);
    const EffluentReport linear = evaluated(std::string("bsm1_fmbpc_linear") + influent);
    const std::string of = std::string("bsm1_fmbpc") + influent + ", fuzzy below linear, ";
    rows.push_back(
        check(of + "EQI", linear.EQI - fuzzy.EQI, Direction::kHigher, 0.0, "kg/d", "ours"));
    rows.push_back(check(of + "OCI", linear.OCI - fuzzy.OCI, Direction::kHigher, 0.0, "-", "ours"));
  }
  return rows;
}

Rows largerBlowers() {
  return compared({{"bsm1_fmbpc_360", kDry, 5.5, 3.0, 7.0, 15.0},
                   {"bsm1_fmbpc_360_rain", kRain, 4.0, 3.0, 4.0, 17.5}});
}

Rows classB() {
  return compared({{"bsm1_supervisor_sludge", kDry, 12.0, -5.0, 0.0, 12.0},
                   {"bsm1_supervisor_sludge_rain", kRain, 10.0, -5.0, 0.0, 13.0},
                   {"bsm1_fmbpc_sludge", kDry, 12.0, -5.0, 0.0, 12.0},
                   {"bsm1_fmbpc_sludge_rain", kRain, 10.0, -5.0, 0.0, 13.0}});
}

/// 2.5 % of the range on every analyser; the default's too.
Rows noise() {
  return compared({{"bsm1_fmbpc_noise", kDry, 2.0, 0.0, 12.0, 17.4},
                   {"bsm1_fmbpc_noise_rain", kRain, 1.5, 0.0, 6.5, 23.0}},
                  {{"plant.parameters.local_noise", "0.025"}});
}

Rows unseen() {
  return compared({{"bsm1_own_supervisor", "bsm1_own_default", 0.0, 0.0, 20.2, 5.5},
                   {"bsm1_own_fmbpc", "bsm1_own_default", 0.0, 0.0, 20.2, 5.5},
                   {"bsm1_own_fmbpc_clp", "bsm1_own_default", 0.0, 0.0, 20.2, 5.5}});
}

const bool kRegistered = registerExperiments(
    {{"bsm1_baseline", "bsm1", "beyond the paper", "supervisor of ammonium, class A", "8 numbers",
      "bsm1_supervisor, bsm1_supervisor_rain", baseline},
     {"bsm1_class_a", "bsm1", "beyond the paper", "predictive control, class A", "-",
      "bsm1_fmbpc, bsm1_fmbpc_clp, dry and rain", classA},
     {"bsm1_class_a_aim", "bsm1", "beyond the paper", "past the baseline, class A", "-",
      "bsm1_fmbpc, bsm1_fmbpc_clp, dry and rain", aim},
     {"bsm1_class_a_360", "bsm1", "beyond the paper", "class A with blowers up to 360 1/d", "-",
      "bsm1_fmbpc_360, dry and rain", largerBlowers},
     {"bsm1_class_b", "bsm1", "beyond the paper", "class B, Qw 260", "-",
      "bsm1_supervisor_sludge, bsm1_fmbpc_sludge, dry and rain", classB},
     {"bsm1_linear_twin", "bsm1", "beyond the paper", "fuzzy against linear, same tuning", "-",
      "bsm1_fmbpc, bsm1_fmbpc_linear, dry and rain", linearTwin},
     {"bsm1_noise", "bsm1", "beyond the paper", "noise on all analysers, class A", "-",
      "bsm1_fmbpc_noise, dry and rain", noise},
     {"bsm1_unseen", "bsm1", "beyond the paper", "an influent that nothing was tuned on", "-",
      "bsm1_own_default, bsm1_own_supervisor, bsm1_own_fmbpc, bsm1_own_fmbpc_clp", unseen}});

}  // namespace
}  // namespace fpc::tool
