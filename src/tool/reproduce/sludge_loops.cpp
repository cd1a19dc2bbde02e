// The control experiments of the activated-sludge thesis (Vallejo Llamas 2021, all three articles).
// Its disturbance records were never published; the seeded pattern stands for them, so that only
// ratios between controllers on the same data can be compared.
#include <cmath>

#include "tool/reproduce/experiment.hpp"
#include "tool/reproduce/runs.hpp"

namespace fpc::tool {
namespace {

using Rows = std::vector<ReproduceRow>;

constexpr char kUnpublished[] = "the paper's disturbance record was never published";

double iseOf(const std::string& loop, const std::string& output) {
  return indicesOf(summaryOf(loop), output).ise;
}

/// Below 1 the law is better than a rival that the paper does not have.
ReproduceRow against(const std::string& what, double ratio, const std::string& note) {
  return state(what, ratio, "-", ratio < 1.0 ? Verdict::kBetter : Verdict::kNotReproducible,
               ratio < 1.0 ? note : note + "; the rival is ahead");
}

ReproduceRow saved(const std::string& what, double paper, double here) {
  ReproduceRow row = compare(what, paper, here, "%", 0.1, kUnpublished);
  if (here > paper && row.verdict != Verdict::kReproduced) row.verdict = Verdict::kBetter;
  return row;
}

void addIse(Rows& rows, const std::string& what, double paper, double here) {
  rows.push_back({what, paper, here, "(mg/l)^2", Verdict::kNotReproducible, kUnpublished});
}

/// Paper: ISE of s with FMBPC and PI, of x with FMBPC and PI. `rival` is the loop without _pi_s.
Rows table11(const std::string& loop, const std::string& rival, const double (&paper)[4]) {
  const double s = iseOf(loop, "s"), x = iseOf(loop, "x"), pi_s = iseOf(rival + "_pi_s", "s"),
               pi_x = iseOf(rival + "_pi_s", "x");
  Rows rows;
  addIse(rows, "ISE of s, FMBPC", paper[0], s);
  addIse(rows, "ISE of s, PI on s", paper[1], pi_s);
  addIse(rows, "ISE of x, FMBPC", paper[2], x);
  addIse(rows, "ISE of x, PI on s", paper[3], pi_x);
  rows.push_back(compare("ISE of s, FMBPC against PI on s", paper[0] / paper[1], s / pi_s, "-",
                         0.15, kUnpublished));
  rows.push_back(saved("ISE of x saved against PI on s", 100.0 * (1.0 - paper[2] / paper[3]),
                       100.0 * (1.0 - x / pi_x)));
  rows.push_back(saved("ISE of both outputs saved against PI on s",
                       100.0 * (1.0 - (paper[0] + paper[2]) / (paper[1] + paper[3])),
                       100.0 * (1.0 - (s + x) / (pi_s + pi_x))));
  rows.push_back(against("ISE of x, FMBPC against PI on x", x / iseOf(rival + "_pi_x", "x"),
                         "not in the paper"));
  return rows;
}

/// Root mean square of x about its reference trajectory [mg/l].
double trackingOf(const std::string& loop) {
  const Summary& run = summaryOf(loop);
  return std::sqrt(indicesOf(run, "x").ise_reference / (run.steps + 1.0));
}

/// Cases A and B of article 1: curves only.
Rows followed(const std::string& loop) {
  Rows rows;
  const std::string figures = std::string(
      "figures only; neither model nor influent of cases A "
      "and B was published; ours stand for them");
  rows.push_back(state("rms of x about its reference trajectory", trackingOf(loop), "mg/l",
                       Verdict::kNotReproducible, figures));
  rows.push_back(state("rmse of s", indicesOf(summaryOf(loop), "s").rmse, "mg/l",
                       Verdict::kNotReproducible, figures));
  for (const char* rival : {"_pi_s", "_pi_x"})
    for (const char* output : {"x", "s"})
      rows.push_back(against(std::string("ISE of ") + output + ", FMBPC against " + loop + rival,
                             iseOf(loop, output) / iseOf(loop + rival, output),
                             "the paper runs no PI in cases A and B"));
  return rows;
}

ReproduceRow lower(const std::string& what, double ratio, const char* note) {
  return state(what, ratio, "-", ratio < 1.0 ? Verdict::kReproduced : Verdict::kNotReproducible,
               ratio < 1.0 ? note : std::string(note) + "; not so here: " + kUnpublished);
}

Rows caseB() {
  Rows rows = followed("asp_case_b");
  rows.push_back(lower("rms of x about its reference, case B / case A",
                       trackingOf("asp_case_b") / trackingOf("asp_case_a"),
                       "the paper finds x followed better than in case A"));
  const InputIndices &a = summaryOf("asp_case_a").inputs.at(0),
                     &b = summaryOf("asp_case_b").inputs.at(0);
  rows.push_back(lower("largest q_r, case B / case A", b.max / a.max, "figures 15 and 18: lower"));
  rows.push_back(lower("range of q_r, case B / case A", (b.max - b.min) / (a.max - a.min),
                       "figures 15 and 18: smaller"));
  return rows;
}

/// The orderings that the figures of article 2 show.
Rows case2021(const std::string& loop, const std::string& rivals) {
  Rows rows;
  for (const char* rival : {"_pi_s", "_pi_x"}) {
    const double x = iseOf(loop, "x") / iseOf(rivals + rival, "x"),
                 ratio_s = iseOf(loop, "s") / iseOf(rivals + rival, "s");
    const std::string name = std::string(", FMBPC against ") + (rivals + rival);
    if (loop == "asp_case3") {
      rows.push_back(against("ISE of x" + name, x, "the paper runs no PI in case 3"));
      continue;
    }
    rows.push_back(state("ISE of x" + name, x, "-",
                         x < 1.0 ? Verdict::kReproduced : Verdict::kNotReproducible,
                         "the figures show FMBPC nearer to the setpoint; no number is printed"));
    const bool lower_s = loop == "asp_case2" && std::string(rival) == "_pi_s";
    const bool agrees = lower_s ? ratio_s > 1.0 : ratio_s > 0.8 && ratio_s < 1.15;
    rows.push_back(state("ISE of s" + name, ratio_s, "-",
                         agrees ? Verdict::kReproduced : Verdict::kNotReproducible,
                         lower_s ? "figure 9: the PI on s holds s lower" : "figures: alike"));
  }
  return rows;
}

/// Case 1 beside rivals that were tuned for what the table counts.
Rows case1(const std::string& loop) {
  Rows rows = case2021(loop, "asp_case1");
  const double tuned = iseOf("asp_case1_pi_x_tuned", "x");
  rows.push_back(against("ISE of x, FMBPC against asp_case1_pi_x_tuned", iseOf(loop, "x") / tuned,
                         "a PI on x tuned for ISE, not in the paper"));
  if (loop == "asp_case1")
    rows.push_back(against("ISE of x, asp_best against asp_case1_pi_x_tuned",
                           iseOf("asp_best", "x") / tuned,
                           "preview, x_r measured, iterated law: ours, not in the paper"));
  return rows;
}

Rows clp(const std::string& loop) {
  const Summary& law = summaryOf(loop);
  const auto broken = static_cast<double>(law.input_violations + law.move_violations +
                                          law.clp_infeasible + law.clp_failed);
  Rows rows;
  rows.push_back(state("bounds broken or programmes without solution", broken, "samples",
                       broken == 0.0 ? Verdict::kReproduced : Verdict::kNotReproducible,
                       "the paper finds the constraints kept in every case"));
  rows.push_back(state("rmse of x", indicesOf(law, "x").rmse, "mg/l", Verdict::kNotReproducible,
                       std::string("figures only; ") + kUnpublished));
  for (const char* rival : {"_pi_s", "_pi_x"})
    rows.push_back(against("ISE of x, FMBPC/CLP against " + loop + rival,
                           iseOf(loop, "x") / iseOf(loop + rival, "x"),
                           "the paper runs no PI beside FMBPC/CLP"));
  return rows;
}

const bool kRegistered = [] {
  const std::string thesis = "Vallejo Llamas 2021, article ", ours = ", with a model of our own";
  const auto add = [&](const char* name, const std::string& source, std::function<Rows()> rows) {
    registerExperiment({name, thesis + source, std::move(rows)});
  };
  static constexpr double kC[] = {3.9824e5, 4.0415e5, 1.1959e5, 4.3241e6};
  static constexpr double kD[] = {3.9619e5, 4.0415e5, 1.2063e6, 6.7338e6};
  add("asp_case_a", "1, figures 13-15", [] { return followed("asp_case_a"); });
  add("asp_case_b", "1, figures 16-18", caseB);
  add("asp_case_c", "1, table 11", [] { return table11("asp_case_c", "asp_case_c", kC); });
  add("asp_case_c_own", "1, table 11" + ours,
      [] { return table11("asp_case_c_own", "asp_case_c", kC); });
  add("asp_case_d", "1, table 11", [] { return table11("asp_case_d", "asp_case_d", kD); });
  add("asp_case_d_own", "1, table 11" + ours,
      [] { return table11("asp_case_d_own", "asp_case_d", kD); });
  add("asp_case1", "2, figures 5-7", [] { return case1("asp_case1"); });
  add("asp_case1_own", "2, figures 5-7" + ours, [] { return case1("asp_case1_own"); });
  add("asp_case2", "2, figures 8-10", [] { return case2021("asp_case2", "asp_case2"); });
  add("asp_case3", "2, figure 11", [] { return case2021("asp_case3", "asp_case3"); });
  for (const char* loop :
       {"asp_clp_1a", "asp_clp_1b", "asp_clp_1c", "asp_clp_2a", "asp_clp_2b", "asp_clp_2c"})
    add(loop, "3, table 1", [name = std::string(loop)] { return clp(name); });
  return true;
}();

}  // namespace
}  // namespace fpc::tool
