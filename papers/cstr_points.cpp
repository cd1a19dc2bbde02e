// The stirred-tank reactor (blazic2007), sections 2 to 4: steady states, the sets and
// coefficients of the fuzzy model, the propositions on the horizon.
#include <algorithm>
#include <cmath>

#include "analysis/transfer.hpp"
#include "fmbpc/base/input_error.hpp"
#include "papers/picture.hpp"
#include "papers/runs.hpp"
#include "runtime/plant_continuation.hpp"

namespace fpc::tool {
namespace {

constexpr double kA1[] = {-1.3462, -1.4506, -1.5681, -1.7114, -1.8111, -1.9157};
constexpr double kA2[] = {0.4298, 0.5262, 0.6437, 0.7689, 0.8592, 0.9485};
constexpr double kB[] = {1.8124e-4, 2.1795e-4, 2.7762e-4, 2.6703e-4, 2.8716e-4, 2.85e-4};
constexpr double kR[] = {-1.1089e-2, -1.5115e-2, -2.1101e-2, -2.1917e-2, -2.5270e-2, -2.7301e-2};

PlantContinuation continuationOf(double compensator) {
  const std::shared_ptr<const Plant> plant = makePlant("cstr", {{"compensator_gain", compensator}});
  return plantContinuation(plant, 0, 6.0, -1.0, -1.0);
}

/// Points of one kind, the largest coolant flow first.
std::vector<SpecialPoint> special(double compensator, SpecialKind kind) {
  const PlantContinuation set = continuationOf(compensator);
  std::vector<SpecialPoint> found;
  for (const auto& branch : continueBranches(set.problem, set.params))
    for (const auto& point : branch.special)
      if (point.kind == kind) found.push_back(point);
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.parameter > b.parameter; });
  return found;
}

struct Place {
  double flow{notPrinted()}, CA{notPrinted()};
};

Place placeOf(const std::vector<SpecialPoint>& found, std::size_t i) {
  return i < found.size() ? Place{found[i].parameter, found[i].state[0]} : Place{};
}

/// Of the working branch, at the nominal coolant flow: CA and T.
Vector nominal() {
  const PlantContinuation set = continuationOf(0.0);
  for (const auto& point : steadyStatesAt(set.problem, set.params, 103.4066))
    if (point.state[0] < 0.12) return point.state;
  return Vector::Constant(2, notPrinted());
}

Rows table1() {
  const Vector state = nominal();
  return {figure("CA at q_c = 103.41", 0.1, state[0], "mol/l"),
          figure("T at q_c = 103.41", 438.54, state[1], "K")};
}

Rows section2() {
  const auto folds = special(0.0, SpecialKind::kFold);
  const Place upper = placeOf(folds, 0), lower = placeOf(folds, 1),
              hopf = placeOf(special(0.0, SpecialKind::kHopf), 0),
              moved = placeOf(special(3.0, SpecialKind::kHopf), 0);
  return {figure("upper fold, q_c", 119.7, upper.flow, "l/min"),
          incomparable("upper fold, CA", notPrinted(), upper.CA, "mol/l", "not printed"),
          figure("lower fold, q_c", 11.1, lower.flow, "l/min"),
          figure("lower fold, CA", 0.92, lower.CA, "mol/l"),
          figure("Hopf point, q_c", 111.8, hopf.flow, "l/min"),
          figure("Hopf point, CA", 0.14, hopf.CA, "mol/l"),
          figure("Hopf point, compensated, q_c", 116.2, moved.flow, "l/min"),
          figure("Hopf point, compensated, CA", 0.179, moved.CA, "mol/l")};
}

/// The sets that stand for the lost figure 1: model A of a static fit, B calibrated.
Rows figure1() {
  const char* lost = "the picture is lost, no number of it is in the text";
  Rows rows;
  for (const char* loop : {"cstr_tracking_literal", "cstr_tracking_literal_b"}) {
    const OutputModel model = readLoop(loop).model.submodels[0];
    for (const bool first : {true, false}) {
      const Rule& rule = first ? model.rules.front() : model.rules.back();
      rows.push_back(incomparable(std::string(loop) + (first ? ": first centre" : ": last centre"),
                                  notPrinted(), rule.antecedents.at(0).parameters.at(0), "mol/l",
                                  lost));
      rows.back().behind = loop;
    }
  }
  return rows;
}

/// Eq. 12 beside what `cstr_own` identified: rule by rule, both ordered along CA.
Rows equation12() {
  const auto rules = readLoop("cstr_tracking_own").model.submodels[0].rules;
  require(rules.size() == 6, "cstr_tracking_own", "six rules");
  Rows rows;
  const auto add = [&](const char* what, const double(&printed)[6], const char* unit, auto&& here) {
    for (std::size_t i = 0; i < 6; ++i)
      rows.push_back(figure(std::string(what) + " of rule " + std::to_string(i + 1), printed[i],
                            here(rules[i]), unit, {0.1}, "our record and our six sets"));
  };
  add("a1", kA1, "-", [](const Rule& r) { return -r.coefficients[0]; });
  add("a2", kA2, "-", [](const Rule& r) { return -r.coefficients[1]; });
  add("b1", kB, "mol min/l2", [](const Rule& r) { return r.coefficients[2]; });
  add("r1", kR, "mol/l", [](const Rule& r) { return r.offset; });
  return rows;
}

Rows propositions() {
  Propositions worst;
  for (int i = 0; i < 6; ++i) {
    const Propositions p = checkPropositions(canonicalRule(kA1[i], kA2[i], kB[i]), 3000);
    worst.gain_below = std::max(worst.gain_below, p.gain_below);
    worst.zeros_distance = std::max(worst.zeros_distance, p.zeros_distance);
    worst.poles_distance = std::max(worst.poles_distance, p.poles_distance);
  }
  const char* all = "largest over the six rules";
  return {check("1: g0 for H < rho", worst.gain_below, Direction::kLower, 0.0, "-", all),
          check("2: poles to zeros and origin, H = rho", worst.zeros_distance, Direction::kLower,
                1e-6, "-", all),
          check("3: poles to open-loop poles, H = 3000", worst.poles_distance, Direction::kLower,
                1e-6, "-", all)};
}

const bool kRegistered = registerExperiments(
    {{"cstr_table_1", "blazic2007", "table 1", "nominal operating point", "2 numbers",
      "fmbpc stability cstr_tracking", table1},
     {"cstr_section_2", "blazic2007", "section 2", "folds and Hopf points of the static curve",
      "7 numbers", "fmbpc stability cstr_tracking", section2},
     {"cstr_figure_1", "blazic2007", "figure 1", "membership functions", "curves",
      "cstr_tracking_literal, cstr_tracking_literal_b", figure1},
     {"cstr_equation_12", "blazic2007", "eq. 12", "coefficients of the six rules", "24 numbers",
      "fmbpc identify of a run of cstr_excite, structure cstr (config/model/cstr_own.yaml)",
      equation12},
     {"cstr_propositions", "blazic2007", "propositions 1-3", "what the horizon does", "statements",
      "fmbpc stability cstr_tracking_literal", propositions}});

const bool kPicture = registerPicture("cstr_figure_1", [] {
  const LoopFile loop = readLoop("cstr_tracking_literal");
  return pictureOfSets(loop.model.submodels.at(0), 0, "CA [mol/l]", 0.04, 0.19);
});

}  // namespace
}  // namespace fpc::tool
