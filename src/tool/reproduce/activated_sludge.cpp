// The stability tables of the activated-sludge thesis (Vallejo Llamas 2021, article 2).
#include "fmbpc/analysis/closed_loop.hpp"
#include "tool/reproduce/experiment.hpp"

namespace fpc::tool {
namespace {

const Matrix kA = (Matrix(2, 2) << 0.80, 0.77, 0.0, 0.88).finished();
const Matrix kB = (Matrix(2, 2) << 0.90, 0.57, 0.81, 0.0).finished();

std::vector<ReproduceRow> table7() {
  std::vector<ReproduceRow> rows;
  for (const int H : {6, 10, 100, 1000}) {
    const Matrix loop = paperReducedLoop(kA, kB, H);
    const std::string at = ", H = " + std::to_string(H) + ", f = 0.88";
    rows.push_back(compare("eigenvalue 1 of A_CL" + at, 0.0, loop(0, 0), "-"));
    rows.push_back(
        compare("eigenvalue 2, formula 59" + at, paperSecondEigenvalue(0.88, H), loop(1, 1), "-"));
  }
  return rows;
}

std::vector<ReproduceRow> table8() {
  std::vector<ReproduceRow> rows;
  const struct {
    int H;
    double element, eigenvalue;
  } printed[] = {{6, 0.8682, 0.7759}, {10, -3.6440, 0.8336}, {100, -51653.6594, 0.8799}};
  for (const auto& row : printed) {
    const Matrix loop = paperReducedLoop(kA, kB, row.H);
    const std::string at = ", H = " + std::to_string(row.H);
    rows.push_back(compare("element (1,2) of A_CL" + at, row.element, loop(0, 1), "-"));
    if (row.element * loop(0, 1) < 0.0)
      rows.back().note = "same size, opposite sign: the paper drops the minus";
    rows.push_back(compare("eigenvalue 2" + at, row.eigenvalue, loop(1, 1), "-"));
  }
  const Matrix longest = paperReducedLoop(kA, kB, 1000);
  rows.push_back(compare("eigenvalue 2, H = 1000", 0.88, longest(1, 1), "-"));
  LoopLaw law;
  const ClosedLoop loop = closeLoop(paperModel(kA, kB), law);
  rows.push_back({"eigenvalue 1 with u(k-1) as a state, H = 6", 0.0, loop.values[0].real(), "-",
                  Verdict::kNotReproducible,
                  "the paper's 0 takes u(k-1) for a free input; the loop has {0, a, eig2}"});
  return rows;
}

const bool kRegistered =
    registerExperiment({"asp_table_7", "Vallejo Llamas 2021, article 2, table 7", table7}) &&
    registerExperiment({"asp_table_8", "Vallejo Llamas 2021, article 2, table 8", table8});

}  // namespace
}  // namespace fpc::tool
