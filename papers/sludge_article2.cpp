// The control experiments of articles 2 and 3 of the activated-sludge thesis (vallejo2021thesis):
// cases 1 to 3, and FMBPC/CLP.
#include <cmath>

#include "papers/sludge_rows.hpp"

namespace fpc::tool {
namespace {

constexpr char kArticle2[] = "vallejo2021a", kArticle3[] = "vallejo2021b";
constexpr char kNearer[] = "the paper: FMBPC nearer to the setpoint of x";
constexpr char kAlike[] = "the paper: very similar";

Rows case1() {
  return {substrateBeside("asp_case1"), followsReference("asp_case1", 2000.0),
          inputBeside("asp_case1")};
}

Rows case2() {
  return {substrateBeside("asp_case2"), followsReference("asp_case2", 750.0),
          check("mean move of q_r, case 2 / case 1",
                ratio(inputOver("asp_case2", meanMove), inputOver("asp_case1", meanMove)),
                Direction::kLower, 1.0, "-", "the paper: softer than in case 1")};
}

Rows case3() {
  Rows rows{substrateBeside("asp_case3"), followsReference("asp_case3", 750.0),
            ahead("asp_case3", "asp_case2", "s", "the paper: s higher than in case 2",
                  Direction::kHigher)};
  for (const char* baseline : {"asp_case3_pi_s", "asp_case3_pi_x"})
    rows.push_back(ahead("asp_case3", baseline, "x", "the paper runs no PI in case 3"));
  return rows;
}

Rows case1PiS() {
  return {ahead("asp_case1", "asp_case1_pi_s", "x", kNearer),
          ahead("asp_case1", "asp_case1_pi_s", "s", "the paper: s a little higher with the PI"),
          alike("asp_case1", "asp_case1_pi_s", "s", "the paper: similar response of s")};
}

Rows case1PiX() {
  return {ahead("asp_case1", "asp_case1_pi_x", "x", kNearer),
          alike("asp_case1", "asp_case1_pi_x", "s", kAlike)};
}

Rows case2PiS() {
  return {ahead("asp_case2", "asp_case2_pi_s", "x", kNearer),
          ahead("asp_case2", "asp_case2_pi_s", "s", "the paper: the PI on s holds s lower",
                Direction::kHigher)};
}

Rows case2PiX() {
  return {ahead("asp_case2", "asp_case2_pi_x", "x", kNearer),
          alike("asp_case2", "asp_case2_pi_x", "s", "the paper: similar reduction of s"),
          check("mean move of q_r, FMBPC / PI on x",
                ratio(inputOver("asp_case2", meanMove), inputOver("asp_case2_pi_x", meanMove)),
                Direction::kLower, 1.0, "-", "the paper: the PI makes larger efforts more often"),
          check("least q_r of the PI on x", inputOver("asp_case2_pi_x", smallestInput),
                Direction::kLower, 0.0, "m3/h", "the paper: it saturates at zero")};
}

/// Case 1 with our models and beside baselines that were tuned for what the index counts.
Rows baselines() {
  Rows rows;
  for (const char* loop : {"asp_case1", "asp_case1_own", "asp_best"})
    rows.push_back(ahead(loop, "asp_case1_pi_x_tuned", "x",
                         "a PI on x tuned for ISE on seeds 1-4, not in the paper"));
  for (const char* baseline : {"asp_case1_pi_s", "asp_case1_pi_x"})
    rows.push_back(ahead("asp_case1_own", baseline, "x", "with a model of our own"));
  return rows;
}

const char* const kClpLoops[2][3] = {{"asp_clp_1a", "asp_clp_1b", "asp_clp_1c"},
                                     {"asp_clp_2a", "asp_clp_2b", "asp_clp_2c"}};

double broken(const Summary& run) {
  return static_cast<double>(run.input_violations + run.move_violations + run.clp_infeasible +
                             run.clp_failed);
}

Rows kept() {
  Rows rows;
  for (const auto& group : kClpLoops)
    for (const char* loop : group) {
      rows.push_back(check(std::string(loop) + ": bounds broken or programmes without solution",
                           overSeeds(loop, broken).highest(), Direction::kLower, 0.0, "samples",
                           "the paper: the constraints are satisfied; worst of all seeds"));
      rows.back().behind = loop;
    }
  return rows;
}

Rows clp(std::size_t group) {
  const auto& loops = kClpLoops[group];
  Rows rows{followsReference(loops[0], 2000.0), substrateBeside(loops[0])};
  for (const char* loop : loops) {
    rows.push_back(incomparable(std::string(loop) + ": samples at a bound", notPrinted(),
                                activeOver(loop), "%", kUnpublished));
    rows.back().behind = loop;
  }
  for (const std::size_t wider : {0U, 1U})
    rows.push_back(
        check(std::string("samples at a bound, ") + loops[wider] + " - " + loops[wider + 1],
              difference(activeOver(loops[wider]), activeOver(loops[wider + 1])), Direction::kLower,
              0.0, "%", "the paper: the wider the less saturated"));
  for (const char* baseline : {"_pi_s", "_pi_x"})
    rows.push_back(ahead(loops[0], loops[0] + std::string(baseline), "x",
                         "the paper runs no PI beside FMBPC/CLP"));
  return rows;
}

Experiment entry(int number, const char* shows, const char* behind, Rows (*rows)()) {
  const std::string n = std::to_string(number);
  return {"asp2_figure_" + std::string(number < 10 ? "0" : "") + n,
          kArticle2,
          "figure " + n,
          shows,
          "curves",
          behind,
          rows};
}

const bool kRegistered =
    registerExperiments(
        {entry(5, "case 1, FMBPC", "asp_case1", case1),
         entry(6, "case 1, FMBPC and PI on s", "asp_case1, asp_case1_pi_s", case1PiS),
         entry(7, "case 1, FMBPC and PI on x", "asp_case1, asp_case1_pi_x", case1PiX),
         entry(8, "case 2, FMBPC", "asp_case2", case2),
         entry(9, "case 2, FMBPC and PI on s", "asp_case2, asp_case2_pi_s", case2PiS),
         entry(10, "case 2, FMBPC and PI on x", "asp_case2, asp_case2_pi_x", case2PiX),
         entry(11, "case 3, FMBPC", "asp_case3", case3)}) &&
    registerExperiments(
        {{"asp2_baselines", kArticle2, "beyond the paper: case 1, own models and tuned baselines",
          "what a tuned PI and our best loop reach", "none", "asp_case1_pi_x_tuned, asp_best",
          baselines},
         {"asp3_table_1", kArticle3, "table 1", "the six experiments: constraints kept", "settings",
          "asp_clp_1a ... asp_clp_2c", kept},
         {"asp3_figure_4", kArticle3, "figure 4", "case 1: bounds of 200, 100 and 5 m3/h", "curves",
          "asp_clp_1a, asp_clp_1b, asp_clp_1c", [] { return clp(0); }},
         {"asp3_figure_5", kArticle3, "figure 5", "case 2: bounds of 200, 100 and 5 m3/h", "curves",
          "asp_clp_2a, asp_clp_2b, asp_clp_2c", [] { return clp(1); }}});

}  // namespace
}  // namespace fpc::tool
