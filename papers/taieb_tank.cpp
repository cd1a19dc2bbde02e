// The surge tank (taieb2017, eqs. 21-25, table 3): what the printed equations
// do, what the pump allows to any controller, and what the three controllers reach here.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identify.hpp"
#include "papers/run_data.hpp"
#include "papers/runs.hpp"
#include "papers/taieb_steps.hpp"
#include "study/shortest_step.hpp"

namespace fpc::tool {
namespace {

constexpr double kAllowed = 0.5;  // [%], the overshoot of table 3

/// Eq. 22 as printed, one sample on: the area is missing beside H(k-1).
double printedLevel(double H, double Q) {
  const double A = 0.04, a = 1e-4, Hs = 0.015, g = 9.81, Te = 0.1;
  return (H + Te * (Q - 0.6 * a * std::sqrt(2.0 * g * (H - Hs)))) / A;
}

/// Of eq. 22 from the plant, over each sample of a run that starts at a level and a flow of it.
double farthestLevel() {
  const RunRecord& run = recordOf("surge_tank_excite");
  double farthest = 0.0;
  for (std::size_t k = 1; k < run.samples.size(); ++k) {
    const Vector &from = run.samples[k - 1].state.state, &to = run.samples[k].state.state;
    farthest = std::max(farthest, std::abs(printedLevel(from[0], from[1]) - to[0]));
  }
  return farthest;
}

/// Of y(k) = a1 y(k-1) + a2 y(k-2) + a3 y(k-3).
double largestPole(VectorRef a) {
  Matrix companion = Matrix::Zero(3, 3);
  companion.row(0) = a.head(3).transpose();
  companion(1, 0) = companion(2, 1) = 1.0;
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

/// Eq. 24 beside what our record gives, rules by their level.
Rows equations() {
  const Structure structure = readStructure(findStructure("surge_tank"));
  const auto rules = identify(dataOf(recordOf("surge_tank_excite"), structure), structure)
                         .model.submodels.at(0)
                         .rules;
  require(rules.size() == 2, "surge_tank", "two rules, as printed");
  const double printed[2][5] = {{1.952, 0.0487, 0.0522, 0.1131, 0.1106},
                                {0.8421, 0.0808, 0.0764, 0.1668, 0.1697}};
  const char* const names[] = {"a1", "a2", "a3", "b1", "b2"};
  Rows rows{check("eq. 22 as printed: largest distance from the plant after a sample",
                  farthestLevel(), Direction::kLower, 1e-3, "m",
                  "the area is missing beside H(k-1); the limit is ours")};
  for (std::size_t r = 0; r < 2; ++r) {
    const std::string rule = ", rule " + std::to_string(r + 1);
    const Vector as_printed = Eigen::Map<const Vector>(printed[r], 5);
    char note[80];
    std::snprintf(note, sizeof note, "as printed the largest pole of the rule is %.4g",
                  largestPole(as_printed));
    for (Eigen::Index i = 0; i < 5; ++i)
      rows.push_back(figure(std::string("eq. 24, ") + names[i] + rule, as_printed[i],
                            rules[r].coefficients[i], i < 3 ? "-" : "m/A", {}, i == 0 ? note : ""));
    rows.push_back(check("identified here: largest pole" + rule, largestPole(rules[r].coefficients),
                         Direction::kLower, 1.0, "-", "the tank itself is stable"));
  }
  return rows;
}

struct Algorithm {
  const char *name, *loop;
  double rise, settling, overshoot, peak;  // as printed
};
constexpr Algorithm kAlgorithms[] = {
    {"NMPC", "surge_tank_steps_nmpc", 0.8111, 5.6402, 6.0804, 1.26},
    {"FMPC-APSO (swarm each sample)", "surge_tank_steps_swarm", 0.9820, 11.0788, 2.6922, 0.2055},
    {"FOMPC-APSO", "surge_tank_steps", 0.7402, 1.9936, 0.5017, 0.2162}};

void addEnergy(Rows& rows) {
  const double own = inputEnergy("surge_tank_steps");
  const char* note = "levels fix the currents that hold them";
  const Judged lower{0.1, Direction::kLower};
  rows.push_back(figure("W: energy of FOMPC-APSO / NMPC", 53.4,
                        100.0 * own / inputEnergy("surge_tank_steps_nmpc"), "%", lower, note));
  rows.push_back(figure("W: energy of FOMPC-APSO / FMPC-APSO", 54.86,
                        100.0 * own / inputEnergy("surge_tank_steps_swarm"), "%", lower, note));
}

Rows table3() {
  Rows rows;
  const double least = shortestStep(readLoop("surge_tank_up"), 0.20, kAllowed).rise_s;
  char note[120];
  std::snprintf(note, sizeof note, "Tr >= %.2f s for any controller with this pump", least);
  for (const Algorithm& a : kAlgorithms) {
    // a baseline that is better here than there is no merit of the paper's method
    const bool baseline = &a != &kAlgorithms[2];
    const Direction side = baseline ? Direction::kEqual : Direction::kLower;
    const Judged lower{0.1, side}, absolute{0.1, side, 0.005};
    const StepIndices up = stepsOf(a.loop, 0, 1.0).front();
    const std::string of = std::string(a.name) + ", ";
    const auto add = [&](const char* what, double paper, double here, const char* unit,
                         const Judged& judged, const char* why) {
      rows.push_back(figure(of + what, paper, here, unit, judged, why));
      rows.back().behind = a.loop;
    };
    add("Tr", a.rise, up.rise, "s", lower, note);
    add("Ts", a.settling, up.settling, "s", lower, note);
    add("Ov", a.overshoot, up.overshoot, "%", lower, "first step, 0.15 to 0.20 m");
    add("peak above the setpoint of 0.20 m", a.peak - 0.20, (up.to - up.from) * 0.01 * up.overshoot,
        "m", {}, "the printed peaks fit neither the printed Ov nor each other");
    add("Es", 0.0, 0.01 * up.offset, "-", absolute, "printed as 0.00");
  }
  addEnergy(rows);
  return rows;
}

/// What the pump allows to any controller, against the printed rise time.
Rows bounds() {
  const auto bound = [](const char* what, const LoopFile& loop, double target) {
    return check(what, shortestStep(loop, target, kAllowed).rise_s, Direction::kLower, 0.7402, "s",
                 "the printed 0.7402 s must be possible; the pump cannot reverse");
  };
  return {bound("least Tr of 0.15 to 0.20 m, current <= 0.03", readLoop("surge_tank_up"), 0.20),
          bound("the same, current <= 1",
                readLoop("surge_tank_up", {{"actuator.input_upper", "{I: 1}"}}), 0.20),
          bound("least Tr of 0.30 to 0.25 m", readLoop("surge_tank_down"), 0.25)};
}

/// Figure 4: steps at 0, 30, 60 and 90 s by three controllers.
Rows figure4() {
  Rows rows;
  double cost[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto steps = stepsOf(kAlgorithms[i].loop, 0, 1.0);
    cost[i] = meanOf(steps).cost();
    rows.push_back(check(std::string(kAlgorithms[i].name) + ", mean offset of the four steps",
                         meanOf(steps).offset, Direction::kLower, 1.0, "%",
                         "the paper: the level follows; 1 % of a step is ours"));
    rows.back().behind = kAlgorithms[i].loop;
  }
  for (const std::size_t baseline : {0U, 1U})
    rows.push_back(check(
        std::string("10 Es + Ov + Ts + Tr, FOMPC-APSO / ") + kAlgorithms[baseline].name,
        cost[2] / cost[baseline], Direction::kLower, 1.0, "-", "the paper: the best of the three"));
  return rows;
}

double residual(const Overrides& overrides, std::size_t from, std::size_t to) {
  const RunRecord& record = recordOf("surge_tank_disturbance", overrides);
  double largest = 0.0;
  for (std::size_t k = from; k <= to; ++k)
    largest = std::max(largest, std::abs(record.samples.at(k).state.outputs[0] - 0.20));
  return largest;
}

/// Figure 5: a feed from 40 to 80 s.
Rows figure5() {
  const Overrides outside{{"controller.disturbance", "outside"}};
  return {check("residual at 58-60 s", residual({}, 580, 600), Direction::kLower, 1e-6, "m",
                "the paper: rejected; the limit is ours"),
          check("residual at 88-90 s", residual({}, 880, 900), Direction::kLower, 1e-7, "m",
                "the paper: rejected; the limit is ours"),
          check("estimate outside the recursion: residual at 60 s", residual(outside, 600, 600),
                Direction::kLower, 1e-6, "m", "not offset-free for P > 1: it belongs inside")};
}

Rows limits() {
  const StepIndices up = stepsOf("surge_tank_up", 0, 1.0).front();
  const StepIndices down = stepsOf("surge_tank_down", 0, 1.0).front();
  const auto row = [](const char* what, double here, double limit, const char* unit) {
    return check(what, here, Direction::kLower, limit, unit, "what an independent program reaches");
  };
  return {row("FOMPC, up, Tr", up.rise, 2.3, "s"), row("FOMPC, up, Ts", up.settling, 3.8, "s"),
          row("FOMPC, up, Ov", up.overshoot, 1.0, "%"), row("FOMPC, up, Es", up.offset, 0.01, "%"),
          row("FOMPC, down, Tr", down.rise, 12.1, "s")};
}

constexpr char kThree[] = "surge_tank_steps, surge_tank_steps_nmpc, surge_tank_steps_swarm";

const bool kRegistered = registerExperiments(
    {{"taieb_table_3", kTaieb, "table 3", "tank: indices of three controllers", "17 numbers",
      kThree, table3},
     {"taieb_figure_4", kTaieb, "figure 4", "tank: steps of the level", "curves", kThree, figure4},
     {"taieb_figure_5", kTaieb, "figure 5", "tank: a feed disturbance", "curves",
      "surge_tank_disturbance", figure5},
     {"taieb_equations_22_24", kTaieb, "eqs. 22, 24", "tank: plant and model as printed",
      "10 numbers", "fmbpc identify of a run of surge_tank_excite, structure surge_tank",
      equations},
     {"taieb_tank_bounds", kTaieb, "beyond the paper: tank, least rise time",
      "what the pump allows to any controller", "none", "shortestStep() of surge_tank_up", bounds},
     {"taieb_tank_limits", kTaieb, "beyond the paper: tank, independent program", "step indices",
      "none", "surge_tank_up, surge_tank_down", limits}});

}  // namespace
}  // namespace fpc::tool
