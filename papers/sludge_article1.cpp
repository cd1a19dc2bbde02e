// The control experiments of article 1 of the activated-sludge thesis (vallejo2021thesis): cases
// A to D.
#include <cmath>
#include <cstdio>

#include "papers/sludge_rows.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "vallejo2019";

/// Printed ISE: s with FMBPC and PI, x with FMBPC and PI [(mg/l)^2].
struct Printed {
  double s, pi_s, x, pi_x;
};
constexpr Printed kC{3.9824e5, 4.0415e5, 1.1959e5, 4.3241e6};
constexpr Printed kD{3.9619e5, 4.0415e5, 1.2063e6, 6.7338e6};

/// Why indices on our data cannot stand beside the paper's: empty if the same PI scores within a
/// factor of two.
std::string strangeData(const std::string& output, double paper, const Values& here) {
  const double factor = here.median() / paper;
  if (factor > 0.5 && factor < 2.0) return "";
  char text[120];
  std::snprintf(text, sizeof text, "the same PI scores %.3g times the paper's ISE of %s here: %s",
                factor, output.c_str(), "unpublished influent");
  return text;
}

Values percentSaved(const Values& mine, const Values& baseline) {
  const Values left = ratio(mine, baseline);
  std::vector<double> saved;
  for (const double value : left.all()) saved.push_back(100.0 * (1.0 - value));
  return saved;
}

/// FMBPC beside the paper's figures; `baseline` is the loop without _pi_s.
Rows table11(const std::string& name, const std::string& loop, const std::string& baseline,
             const Printed& paper) {
  const Values s = iseOver(loop, "s"), x = iseOver(loop, "x"),
               pi_s = iseOver(baseline + "_pi_s", "s"), pi_x = iseOver(baseline + "_pi_s", "x");
  const std::string no_s = strangeData("s", paper.pi_s, pi_s),
                    no_x = strangeData("x", paper.pi_x, pi_x);
  const Judged equal{0.15}, lower{0.15, Direction::kLower}, higher{0.1, Direction::kHigher};
  Rows rows;
  const auto add = [&](const std::string& what, double printed, Values here, const char* unit,
                       const Judged& judged, const std::string& reason) {
    ReproduceRow row = figure(name + ", " + what, printed, std::move(here), unit, judged);
    row.incomparable = reason;
    row.behind = loop + ", " + baseline + "_pi_s";
    rows.push_back(std::move(row));
  };
  add("ISE of s, FMBPC", paper.s, s, "(mg/l)^2", lower, no_s);
  add("ISE of s, PI on s", paper.pi_s, pi_s, "(mg/l)^2", equal, no_s);
  add("ISE of x, FMBPC", paper.x, x, "(mg/l)^2", lower, no_x);
  add("ISE of x, PI on s", paper.pi_x, pi_x, "(mg/l)^2", equal, no_x);
  add("ISE of s, FMBPC / PI on s", paper.s / paper.pi_s, ratio(s, pi_s), "-", lower, no_s);
  add("ISE of x saved against PI on s", 100.0 * (1.0 - paper.x / paper.pi_x), percentSaved(x, pi_x),
      "%", higher, no_x);
  rows.push_back(ahead(loop, baseline + "_pi_x", "x", "the honest baseline, not in the paper"));
  return rows;
}

Rows table11() {
  Rows rows = table11("case C", "asp_case_c", "asp_case_c", kC);
  for (const auto& row : table11("case D", "asp_case_d", "asp_case_d", kD)) rows.push_back(row);
  return rows;
}

/// Runs whose input stays at a limit for the last tenth and more.
double lockedSeeds(const std::string& loop) {
  const Values locked = overSeeds(loop, [](const Summary& run) {
    return contains(run.events, EventCode::kInputAtLimit) ? 1.0 : 0.0;
  });
  double count = 0.0;
  for (const double one : locked.all()) count += one;
  return count;
}

Rows ownModels() {
  Rows rows = table11("case C, own model", "asp_case_c_own", "asp_case_c", kC);
  for (const auto& row : table11("case D, own model", "asp_case_d_own", "asp_case_d", kD))
    rows.push_back(row);
  for (const char* loop : {"asp_case_c_own", "asp_case_d_own"}) {
    rows.push_back(check(std::string(loop) + ": seeds in which the input locks at a limit",
                         lockedSeeds(loop), Direction::kLower, 0.0, "of 24", "ours"));
    rows.back().behind = loop;
  }
  return rows;
}

Rows substrateAlone(const std::string& loop) {
  return {substrateBeside(loop),
          check("rmse of s / its setpoint",
                ratio(rmseOver(loop, "s"), Values(std::vector<double>(kSeeds, 55.0))),
                Direction::kLower, 1.0, "-",
                "the paper: around the reference with acceptable deviations; the limit is ours")};
}

Rows biomassAlone(const std::string& loop, double setpoint) {
  return {incomparable("rmse of x", notPrinted(), rmseOver(loop, "x"), "mg/l", kUnpublished),
          followsReference(loop, setpoint),
          ahead(loop, loop + "_pi_s", "x", "the paper runs no PI in cases A and B"),
          ahead(loop, loop + "_pi_x", "x", "the paper runs no PI in cases A and B")};
}

Rows biomassB() {
  Rows rows = biomassAlone("asp_case_b", 750.0);
  rows.push_back(check("rms of x about its reference, case B / case A",
                       ratio(trackingOver("asp_case_b", "x"), trackingOver("asp_case_a", "x")),
                       Direction::kLower, 1.0, "-", "the paper: better even than in case A"));
  return rows;
}

Rows inputB() {
  const auto compared = [](const char* what, OfInput of) {
    return check(what, ratio(inputOver("asp_case_b", of), inputOver("asp_case_a", of)),
                 Direction::kLower, 1.0, "-", "the paper: lower than in case A");
  };
  return {inputBeside("asp_case_b"), compared("largest q_r, case B / case A", largestInput),
          compared("range of q_r, case B / case A", inputRange)};
}

Rows biomassC() {
  Rows rows{
      incomparable("rmse of x", notPrinted(), rmseOver("asp_case_c", "x"), "mg/l", kUnpublished),
      followsReference("asp_case_c", 1900.0)};
  rows.push_back(check("rms of x about its reference, case C / case D",
                       ratio(trackingOver("asp_case_c", "x"), trackingOver("asp_case_d", "x")),
                       Direction::kLower, 1.0, "-", "the paper: more precise than in case D"));
  return rows;
}

Rows biomassD() {
  return {
      incomparable("rmse of x", notPrinted(), rmseOver("asp_case_d", "x"), "mg/l", kUnpublished),
      followsReference("asp_case_d", 1837.0)};
}

Rows inputBoth(const std::string& loop) {
  return {inputBeside(loop),
          incomparable("largest q_r, PI on s", notPrinted(),
                       inputOver(loop + "_pi_s", largestInput), "m3/h", kUnpublished)};
}

Experiment entry(int number, const char* shows, const std::string& loop, bool baseline,
                 std::function<Rows()> rows) {
  char name[40];
  std::snprintf(name, sizeof name, "asp1_figure_%02d", number);
  return {name,           kPaper,   "figure " + std::to_string(number),
          shows,          "curves", baseline ? loop + ", " + loop + "_pi_s" : loop,
          std::move(rows)};
}

constexpr char kSimilar[] = "the paper: similar responses of the substrate";
constexpr char kLost[] = "the paper: the PI on s loses control of the biomass";

std::vector<Experiment> casesAandB() {
  return {entry(13, "case A, substrate", "asp_case_a", false,
                [] { return substrateAlone("asp_case_a"); }),
          entry(14, "case A, biomass", "asp_case_a", false,
                [] { return biomassAlone("asp_case_a", 1837.0); }),
          entry(15, "case A, recirculation", "asp_case_a", false,
                [] { return Rows{inputBeside("asp_case_a")}; }),
          entry(16, "case B, substrate", "asp_case_b", false,
                [] { return substrateAlone("asp_case_b"); }),
          entry(17, "case B, biomass", "asp_case_b", false, biomassB),
          entry(18, "case B, recirculation", "asp_case_b", false, inputB)};
}

std::vector<Experiment> casesCandD() {
  std::vector<Experiment> all;
  for (const bool c : {true, false}) {
    const std::string loop = c ? "asp_case_c" : "asp_case_d";
    const int first = c ? 19 : 24;
    all.push_back(entry(first, c ? "case C, substrate" : "case D, substrate", loop, false,
                        [loop] { return substrateAlone(loop); }));
    all.push_back(entry(first + 1, "substrate, FMBPC and PI", loop, true,
                        [loop] { return Rows{alike(loop, loop + "_pi_s", "s", kSimilar)}; }));
    all.push_back(entry(first + 2, c ? "case C, biomass" : "case D, biomass", loop, false,
                        c ? biomassC : biomassD));
    all.push_back(entry(first + 3, "biomass, FMBPC and PI", loop, true,
                        [loop] { return Rows{ahead(loop, loop + "_pi_s", "x", kLost)}; }));
    all.push_back(entry(first + 4, "recirculation, FMBPC and PI", loop, true,
                        [loop] { return inputBoth(loop); }));
  }
  return all;
}

std::vector<Experiment> tables() {
  return {{"asp1_table_11", kPaper, "table 11", "ISE of cases C and D", "12 numbers",
           "asp_case_c, asp_case_d", [] { return table11(); }},
          {"asp1_own_models", kPaper, "beyond the paper: table 11, own models",
           "ISE of cases C and D with models of our own", "none", "asp_case_c_own, asp_case_d_own",
           ownModels}};
}

const bool kRegistered = registerExperiments(casesAandB()) && registerExperiments(casesCandD()) &&
                         registerExperiments(tables());

}  // namespace
}  // namespace fpc::tool
