// Which runs and signals stand for which figure of the papers, where runs over time are all.
#include "papers/picture.hpp"
#include "papers/runs.hpp"

namespace fpc::tool {
namespace {

using Names = std::vector<std::string>;

bool add(const std::string& experiment, const Names& loops, const Names& signals,
         const Overrides& overrides = {}) {
  return registerPicture(experiment, [=] {
    std::vector<LabelledRun> runs;
    for (const auto& loop : loops) runs.push_back({&recordOf(loop, overrides), loop});
    return pictureOfRuns(runs, signals);
  });
}

bool addSludge() {
  const Names loads{"q_i", "s_i"};
  const auto number = [](int n) { return std::string(n < 10 ? "0" : "") + std::to_string(n); };
  const auto article1 = [&](int n, const Names& loops, Names signals, bool disturbed) {
    if (disturbed) signals.insert(signals.end(), loads.begin(), loads.end());
    add("asp1_figure_" + number(n), loops, signals);
  };
  article1(4, {"asp_excite"}, {"q_r"}, true);
  article1(5, {"asp_excite"}, {"s", "x"}, false);
  for (const bool a : {true, false}) {
    const std::string loop = a ? "asp_case_a" : "asp_case_b";
    const int first = a ? 13 : 16;
    article1(first, {loop}, {"s"}, true);
    article1(first + 1, {loop}, {"x"}, true);
    article1(first + 2, {loop}, {"q_r"}, false);
  }
  for (const bool c : {true, false}) {
    const std::string loop = c ? "asp_case_c" : "asp_case_d";
    const int first = c ? 19 : 24;
    article1(first, {loop}, {"s"}, true);
    article1(first + 1, {loop, loop + "_pi_s"}, {"s"}, false);
    article1(first + 2, {loop}, {"x"}, true);
    article1(first + 3, {loop, loop + "_pi_s"}, {"x"}, false);
    article1(first + 4, {loop, loop + "_pi_s"}, {"q_r"}, false);
  }
  const Names all{"s", "x", "q_r"}, disturbed{"s", "x", "q_r", "q_i", "s_i"};
  add("asp2_figure_05", {"asp_case1"}, disturbed);
  add("asp2_figure_06", {"asp_case1", "asp_case1_pi_s"}, all);
  add("asp2_figure_07", {"asp_case1", "asp_case1_pi_x"}, all);
  add("asp2_figure_08", {"asp_case2"}, disturbed);
  add("asp2_figure_09", {"asp_case2", "asp_case2_pi_s"}, all);
  add("asp2_figure_10", {"asp_case2", "asp_case2_pi_x"}, all);
  add("asp2_figure_11", {"asp_case3"}, disturbed);
  add("asp3_figure_4", {"asp_clp_1a", "asp_clp_1b", "asp_clp_1c"}, disturbed);
  return add("asp3_figure_5", {"asp_clp_2a", "asp_clp_2b", "asp_clp_2c"}, disturbed);
}

bool addBatch() {
  const Names valves{"Tw", "kM", "kC", "kH"};
  const std::string plain = "batch_fuzzy_eq44", priced = "batch_fuzzy_eq45",
                    linear = "batch_linear_eq45";
  add("batch_figure_06", {plain}, {"T"});
  add("batch_figure_07", {plain}, valves);
  add("batch_figure_08", {priced}, {"T"});
  add("batch_figure_09", {priced}, valves);
  add("batch_figure_10", {linear}, {"T"});
  return add("batch_figure_11", {linear}, valves);
}

bool addTaieb() {
  add("taieb_figure_5", {"surge_tank_disturbance"}, {"H", "I"});
  const Names reactor{"mimo_cstr_steps_nmpc", "mimo_cstr_steps_swarm", "mimo_cstr_steps"};
  const Overrides true_analyser{{"disturbance.commands", "[]"}};
  const char* const signals[] = {"Ca", "T", "q", "qc"};
  for (std::size_t i = 0; i < 4; ++i)
    add("taieb_figure_" + std::to_string(6 + i), reactor, {signals[i]}, true_analyser);
  return true;
}

const bool kRegistered = addSludge() && addBatch() && addTaieb();

}  // namespace
}  // namespace fpc::tool
