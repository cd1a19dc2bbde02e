// The reactor with two inputs (taieb2017, eqs. 26-28, tables 5 and 6): what
// the printed setpoints would need, and what three controllers reach on setpoints within reach.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/steady_state.hpp"
#include "fmbpc/plant/plant.hpp"
#include "papers/experiment.hpp"
#include "papers/runs.hpp"
#include "papers/taieb_steps.hpp"

namespace fpc::tool {
namespace {

const Overrides kTrueAnalyser{{"disturbance.commands", "[]"}};

/// Inputs (q, qc) under which the reactor rests at (Ca, T): the equations solved for the inputs, in
/// logarithms because both are positive.
SteadyState steadyInputs(double Ca, double T) {
  const auto plant = makePlant("mimo_cstr");
  const Vector state = Eigen::Vector2d(Ca, T), feed = Eigen::Vector3d(1.0, 350.0, 350.0);
  const Derivative rates = [&](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> f) {
    plant->derivatives(state, x.array().exp().matrix(), feed, f);
  };
  SteadyState found =
      findSteadyState(rates, Vector::Constant(2, std::log(100.0)), Vector(0), Vector(0));
  found.x = found.x.array().exp().matrix();
  return found;
}

void addPair(Rows& rows, const char* what, double Ca, double T) {
  char pair[60];
  std::snprintf(pair, sizeof pair, "%s (%g mol/l, %g K), ", what, Ca, T);
  const SteadyState inputs = steadyInputs(Ca, T);
  const double q = inputs.ok() ? inputs.x[0] : notPrinted(),
               qc = inputs.ok() ? inputs.x[1] : notPrinted();
  const std::string of = pair;
  const char* range = "steady inputs within 50..150 and 50..200 l/min; the range is ours";
  rows.push_back(check(of + "distance of q from 100", std::abs(q - 100.0), Direction::kLower, 50.0,
                       "l/min", range));
  rows.push_back(check(of + "distance of qc from 125", std::abs(qc - 125.0), Direction::kLower,
                       75.0, "l/min", range));
}

Rows pairs() {
  Rows rows;
  for (const auto& [Ca, T] : {std::pair{0.1, 480.0}, {0.05, 365.0}, {0.15, 495.0}, {0.25, 465.0}})
    addPair(rows, "eq. 28", Ca, T);
  for (const auto& [Ca, T] : {std::pair{0.1, 441.0}, {0.05, 450.0}, {0.15, 430.0}, {0.25, 416.0}})
    addPair(rows, "ours", Ca, T);
  return rows;
}

/// Why the printed figures cannot be had, computed; empty if the pairs of eq. 28 are within reach.
std::string outOfReach() {
  double worst = 0.0;
  for (const auto& [Ca, T] : {std::pair{0.1, 480.0}, {0.05, 365.0}, {0.15, 495.0}, {0.25, 465.0}}) {
    const SteadyState inputs = steadyInputs(Ca, T);
    worst = std::max(worst, inputs.ok() ? inputs.x[0] : INFINITY);
  }
  if (worst <= 150.0) return "";
  char text[120];
  std::snprintf(text, sizeof text,
                "the setpoints of eq. 28 need a feed of up to %.0f l/min; ours are others", worst);
  return text;
}

struct Algorithm {
  const char *name, *loop;
  double rise[2], settling[2], overshoot[2], peak[2];  // as printed, Ca and T [min, min, %, -]
};
constexpr Algorithm kAlgorithms[] = {{"NMPC",
                                      "mimo_cstr_steps_nmpc",
                                      {1.4965, 1.3711},
                                      {6.8561, 9.2185},
                                      {5.0973, 5.4003},
                                      {1.0510, 1.0540}},
                                     {"FMPC-APSO (swarm each sample)",
                                      "mimo_cstr_steps_swarm",
                                      {4.4693, 3.0459},
                                      {7.2779, 4.5471},
                                      {0.1215, 1.6309},
                                      {1.0012, 1.0163}},
                                     {"FOMPC-APSO",
                                      "mimo_cstr_steps",
                                      {0.4135, 0.4116},
                                      {3.5480, 3.2626},
                                      {0.0, 0.0011},
                                      {1.0000, 1.0000}}};

std::vector<StepIndices> stepsOf(const Algorithm& a, Eigen::Index output) {
  return tool::stepsOf(a.loop, output, 60.0, kTrueAnalyser);
}

/// Mean over the three steps of Ca and the four of T.
double meanCost(const Algorithm& a) {
  double sum = 0.0;
  std::size_t n = 0;
  for (const Eigen::Index output : {0, 1})
    for (const StepIndices& step : stepsOf(a, output)) {
      sum += step.cost();
      ++n;
    }
  return sum / static_cast<double>(n);
}

Rows table(Eigen::Index output) {
  const std::string reason = outOfReach();
  const Judged judged{0.1, Direction::kEqual, 0.005};
  Rows rows;
  const auto add = [&](const std::string& what, double paper, double here, const char* unit) {
    rows.push_back(figure(what, paper, here, unit, judged));
    rows.back().incomparable = reason;
  };
  for (const Algorithm& a : kAlgorithms) {
    const StepIndices here = meanOf(stepsOf(a, output));
    const std::string of = std::string(a.name) + ", ";
    add(of + "Tr", a.rise[output], here.rise, "min");
    add(of + "Ts", a.settling[output], here.settling, "min");
    add(of + "Ov", a.overshoot[output], here.overshoot, "%");
    add(of + "Pic, peak / setpoint", a.peak[output], 1.0 + 0.01 * here.overshoot, "-");
    add(of + "Es", 0.0, 0.01 * here.offset, "-");
  }
  const double w[2][2] = {{48.94, 47.28}, {48.14, 49.07}};
  const double own = inputEnergy(kAlgorithms[2].loop, kTrueAnalyser);
  for (const int baseline : {0, 1})
    add(std::string("W: energy of FOMPC-APSO / ") + kAlgorithms[baseline].name, w[output][baseline],
        100.0 * own / inputEnergy(kAlgorithms[baseline].loop, kTrueAnalyser), "%");
  return rows;
}

/// Figures 6 and 7: each output follows, and ours best.
Rows followed(Eigen::Index output) {
  Rows rows;
  double cost[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const StepIndices mean = meanOf(stepsOf(kAlgorithms[i], output));
    cost[i] = mean.cost();
    rows.push_back(check(std::string(kAlgorithms[i].name) + ", mean offset of the steps",
                         mean.offset, Direction::kLower, 1.0, "%",
                         "on our setpoints; 1 % of a step is ours"));
    rows.back().behind = kAlgorithms[i].loop;
  }
  for (const std::size_t baseline : {0U, 1U})
    rows.push_back(
        check(std::string("10 Es + Ov + Ts + Tr, FOMPC-APSO / ") + kAlgorithms[baseline].name,
              cost[2] / cost[baseline], Direction::kLower, 1.0, "-",
              "the paper: the best of the three; on our setpoints"));
  return rows;
}

/// Figures 8 and 9: the control effort of one input.
Rows effort(Eigen::Index input) {
  const auto energy = [&](const Algorithm& a) {
    return summaryOf(a.loop, kTrueAnalyser).inputs.at(static_cast<std::size_t>(input)).energy;
  };
  Rows rows;
  for (const std::size_t baseline : {0U, 1U})
    rows.push_back(check(std::string("energy, FOMPC-APSO / ") + kAlgorithms[baseline].name,
                         energy(kAlgorithms[2]) / energy(kAlgorithms[baseline]), Direction::kLower,
                         1.0, "-", "the paper: a more acceptable effort; on our setpoints"));
  return rows;
}

/// Figure 10: the analyser reads 0.002 mol/l too much from 82 min on, 0.004 from 130 min on.
Rows figure10() {
  const RunRecord& record = recordOf("mimo_cstr_steps", {});
  Rows rows;
  for (const double minute : {82.0, 130.0}) {
    double most = 0.0;
    const auto from = static_cast<std::size_t>(std::lround((minute + 0.2) / 0.01));
    for (std::size_t k = from; k < from + 500; ++k) {
      const SampleRecord& sample = record.samples.at(k);
      most = std::max(most, std::abs(sample.measurement.outputs[0] - sample.tracking.setpoint[0]));
    }
    char what[60];
    std::snprintf(what, sizeof what, "error of Ca from %.1f min on, for 5 min", minute + 0.2);
    rows.push_back(check(what, most, Direction::kLower, 2e-5, "mol/l",
                         "the paper: back at the setpoint; the limit is ours"));
  }
  return rows;
}

/// What an independent program reaches on the same setpoints, P = 5, M = 1.
Rows baselines() {
  const char* note = "what an independent program reaches, 10 % allowed";
  Rows rows;
  const double reference[] = {0.268, 2.93, 0.269};
  for (std::size_t i = 0; i < 3; ++i)
    rows.push_back(check(std::string(kAlgorithms[i].name) + ", 10 Es + Ov + Ts + Tr, 7 steps",
                         meanCost(kAlgorithms[i]), Direction::kLower, 1.1 * reference[i], "-",
                         note));
  rows.push_back(check("cost of FOMPC / NMPC told the truth",
                       meanCost(kAlgorithms[2]) / meanCost(kAlgorithms[0]), Direction::kLower, 1.1,
                       "-", "to reach: at most 1.1"));
  return rows;
}

constexpr char kThree[] = "mimo_cstr_steps, mimo_cstr_steps_nmpc, mimo_cstr_steps_swarm";

Experiment entry(const char* name, const char* item, const char* shows, const char* printed,
                 std::function<Rows()> rows) {
  return {name, kTaieb, item, std::string("reactor: ") + shows, printed, kThree, std::move(rows)};
}

const bool kRegistered = registerExperiments(
    {entry("taieb_table_5", "table 5", "indices of Ca", "17 numbers", [] { return table(0); }),
     entry("taieb_table_6", "table 6", "indices of T", "17 numbers", [] { return table(1); }),
     entry("taieb_figure_6", "figure 6", "Ca", "curves", [] { return followed(0); }),
     entry("taieb_figure_7", "figure 7", "T", "curves", [] { return followed(1); }),
     entry("taieb_figure_8", "figure 8", "effort of q", "curves", [] { return effort(0); }),
     entry("taieb_figure_9", "figure 9", "effort of qc", "curves", [] { return effort(1); }),
     entry("taieb_figure_10", "figure 10", "Ca with a biased analyser", "curves", figure10),
     entry("taieb_equation_28", "eq. 28", "steady inputs of the setpoints", "8 numbers", pairs),
     entry("taieb_reactor_baselines", "beyond the paper: reactor, independent program",
           "cost of the steps", "none", baselines)});

}  // namespace
}  // namespace fpc::tool
