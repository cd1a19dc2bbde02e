// The batch reactor with discrete valves (karer2007, section 6): figures 6 to 14. The paper
// prints curves, no scores: what it says of them is tested; all figures here are means over four
// initial states.
#include <cmath>
#include <map>

#include "base/parallel.hpp"
#include "papers/runs.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "karer2007";
constexpr char kPlain[] = "batch_fuzzy_eq44", kPriced[] = "batch_fuzzy_eq45",
               kLinear[] = "batch_linear_eq45";
constexpr const char* kWindows[] = {"62 degC", "26 degC", "35 degC"};
constexpr const char* kStarts[] = {"{T: 20, Tw: 20}", "{T: 18, Tw: 18}", "{T: 22, Tw: 25}",
                                   "{T: 20, Tw: 30}"};

struct Pooled {
  double rms[3]{}, error[3]{};  // steady windows
  double switches{}, mixing_moves{}, water{};
};

Pooled pooledOf(const std::vector<Summary>& runs) {
  Pooled pooled;
  const double share = 1.0 / static_cast<double>(runs.size());
  for (const Summary& s : runs) {
    for (std::size_t w = 0; w < 3; ++w) {
      pooled.rms[w] += share * s.windows.at(w).rmse * s.windows[w].rmse;
      pooled.error[w] += share * s.windows[w].mean_error;
    }
    pooled.mixing_moves += share * static_cast<double>(s.inputs.at(0).switches);
    pooled.switches += share * static_cast<double>(s.inputs.at(1).switches);
    pooled.water += share * s.consumption.at(0).second;
  }
  for (double& r : pooled.rms) r = std::sqrt(r);
  return pooled;
}

const Pooled& runs(const std::string& loop) {
  static std::map<std::string, Pooled> done;
  const auto known = done.find(loop);
  if (known != done.end()) return known->second;
  std::vector<Summary> all(std::size(kStarts));
  parallelFor(all.size(), 0, [&](std::size_t i) {
    all[i] = freshSummaryOf(loop, {{"plant.initial_state", kStarts[i]}});
  });
  return done.emplace(loop, pooledOf(all)).first->second;
}

/// Figures 6, 8 and 10: the recipe is followed.
Rows followed(const std::string& loop, double most) {
  Rows rows;
  for (std::size_t w = 0; w < 3; ++w)
    rows.push_back(check(std::string("steady rms at ") + kWindows[w], runs(loop).rms[w],
                         Direction::kLower, most, "K",
                         "the paper: the recipe is well followed; the limit is ours"));
  return rows;
}

ReproduceRow pricedShare(const char* what, double Pooled::*of, const std::string& loop,
                         const char* note) {
  ReproduceRow row = check(std::string(what) + ", " + loop + " / " + kPlain,
                           runs(loop).*of / runs(kPlain).*of, Direction::kLower, 1.0, "-", note);
  row.behind = loop + ", " + kPlain;
  return row;
}

Rows valvesPriced(const std::string& loop, const char* note) {
  return {pricedShare("switches of an on/off valve", &Pooled::switches, loop, note),
          pricedShare("moves of the mixing valve", &Pooled::mixing_moves, loop, note),
          pricedShare("fresh water", &Pooled::water, loop, note)};
}

/// Figure 7: the paper finds that valves move too much with eq. 44: more than the recipe needs.
Rows valvesPlain() {
  const Pooled& here = runs(kPlain);
  return {check("switches of an on/off valve", here.switches, Direction::kHigher, 2.0 + 1.0, "-",
                "the paper: the valves move too much; the two steps down need one each"),
          incomparable("moves of the mixing valve", notPrinted(), here.mixing_moves, "-",
                       "curves only"),
          incomparable("fresh water", notPrinted(), here.water, "kg", "curves only")};
}

/// Figures 12 to 14: the hybrid fuzzy model against the hybrid linear one.
Rows compared(std::size_t window, Direction fuzzy) {
  const Pooled &mine = runs(kPriced), &baseline = runs(kLinear);
  const std::string at = std::string(" at ") + kWindows[window];
  return {
      check("mean error, fuzzy - linear" + at, mine.error[window] - baseline.error[window], fuzzy,
            0.0, "K",
            fuzzy == Direction::kHigher ? "the figure: fuzzy higher" : "the figure: fuzzy lower"),
      check("|mean error|, fuzzy / linear" + at,
            std::abs(mine.error[window]) / std::abs(baseline.error[window]), Direction::kLower, 1.0,
            "-", "the paper: nearer to the recipe"),
      check("rms, fuzzy / linear" + at, mine.rms[window] / baseline.rms[window], Direction::kLower,
            1.0, "-", "the paper: the fuzzy model is the better one")};
}

Experiment entry(const std::string& number, const char* shows, const std::string& behind,
                 std::function<Rows()> rows) {
  const std::string item = number[0] == '0' ? number.substr(1) : number;
  return {"batch_figure_" + number, kPaper, "figure " + item, shows, "curves", behind,
          std::move(rows)};
}

constexpr char kLess[] = "the paper: less than with eq. 44";
const std::string kBoth = std::string(kPriced) + ", " + kLinear;

const bool kRegistered = registerExperiments(
    {entry("06", "eq. 44, core", kPlain, [] { return followed(kPlain, 0.5); }),
     entry("07", "eq. 44, valves", kPlain, valvesPlain),
     entry("08", "eq. 45, core", kPriced, [] { return followed(kPriced, 0.5); }),
     entry("09", "eq. 45, valves", kPriced, [] { return valvesPriced(kPriced, kLess); }),
     entry("10", "eq. 45, linear model, core", kLinear, [] { return followed(kLinear, 2.0); }),
     entry("11", "eq. 45, linear model, valves", kLinear,
           [] { return valvesPriced(kLinear, "ours: also with the linear model"); }),
     entry("12", "fuzzy and linear at 62 degC", kBoth,
           [] { return compared(0, Direction::kHigher); }),
     entry("13", "fuzzy and linear at 26 degC", kBoth,
           [] { return compared(1, Direction::kLower); }),
     entry("14", "fuzzy and linear at 35 degC", kBoth,
           [] { return compared(2, Direction::kHigher); })});

}  // namespace
}  // namespace fpc::tool
