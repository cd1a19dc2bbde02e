// The stability tables of the activated-sludge thesis (vallejo2021a).
#include <algorithm>
#include <cmath>

#include "analysis/paper_loop.hpp"
#include "papers/experiment.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "vallejo2021a";
constexpr char kBehind[] = "paperReducedLoop(), eqs. 47 and 64";
constexpr double kLastDigit = 0.5e-4;  // of figures printed with four decimals

const Matrix kA = (Matrix(2, 2) << 0.80, 0.77, 0.0, 0.88).finished();
const Matrix kB = (Matrix(2, 2) << 0.90, 0.57, 0.81, 0.0).finished();

std::string at(int H) { return ", H = " + std::to_string(H); }

/// The table holds formulas: our closed loop must agree with them.
Rows table7() {
  Rows rows;
  for (const int H : {6, 10, 100, 1000}) {
    const Matrix loop = paperReducedLoop(kA, kB, H);
    rows.push_back(check("eigenvalue 1 of A_CL" + at(H), std::abs(loop(0, 0)), Direction::kLower,
                         1e-9, "-", "0 in the paper"));
    rows.push_back(check("eigenvalue 2 of A_CL - formula (59)" + at(H),
                         std::abs(loop(1, 1) - paperSecondEigenvalue(0.88, H)), Direction::kLower,
                         1e-12, "-", "f = 0.88"));
  }
  rows.push_back(check("formula (59) at H = 100000 - f",
                       std::abs(paperSecondEigenvalue(0.88, 100000) - 0.88), Direction::kLower,
                       1e-12, "-", "tends to f"));
  return rows;
}

/// H = 6: how far an eigenvalue of the true loop lies from both of the table's, 0 and eig2.
double farthest() {
  const ClosedLoop full = closeLoop(paperModel(kA, kB), LoopLaw{});
  double most = 0.0;
  for (const auto& value : full.values)
    most = std::max(
        most, std::min(std::abs(value),
                       std::abs(value - paperSecondEigenvalue(0.88, LoopLaw{}.coincidence_steps))));
  return most;
}

Rows table8() {
  const Matrix open = kA;
  const char* given = "the diagonal of the printed matrix (64): nothing is computed";
  Rows rows{incomparable("open loop, eigenvalue 1", 0.8, open(0, 0), "-", given),
            incomparable("open loop, eigenvalue 2", 0.88, open(1, 1), "-", given)};
  const std::pair<int, double> printed[] = {{6, 0.7759}, {10, 0.8336}, {100, 0.8799}, {1000, 0.88}};
  for (const auto& [H, second] : printed) {
    const Matrix loop = paperReducedLoop(kA, kB, H);
    rows.push_back(
        figure("eigenvalue 1" + at(H), 0.0, loop(0, 0), "-", {0.1, Direction::kEqual, kLastDigit}));
    rows.push_back(figure("eigenvalue 2" + at(H), second, loop(1, 1), "-"));
  }
  rows.push_back(check("eigenvalue of the loop with u(k-1) as a state farthest from the table's",
                       farthest(), Direction::kLower, kLastDigit, "-",
                       "the table takes u(k-1) for a free input; the loop has {0, a, eig2}"));
  return rows;
}

Rows elements() {
  Rows rows;
  const std::pair<int, double> printed[] = {{6, 0.8682}, {10, -3.6440}, {100, -51653.6594}};
  for (const auto& [H, element] : printed) {
    const double here = paperReducedLoop(kA, kB, H)(0, 1);
    const bool sign = element * here < 0.0;
    rows.push_back(figure("element (1,2) of A_CL" + at(H), element, here, "-", {},
                          sign ? "same size, opposite sign: the paper drops the minus" : ""));
    if (!sign) continue;
    rows.push_back(
        figure("the same without its sign" + at(H), std::abs(element), std::abs(here), "-"));
  }
  rows.push_back(check("element (1,2)" + at(1000), paperReducedLoop(kA, kB, 1000)(0, 1),
                       Direction::kLower, -1e6, "-", "a very large negative number in the paper"));
  return rows;
}

const bool kRegistered =
    registerExperiments({{"asp2_table_7", kPaper, "table 7",
                          "eigenvalues of the closed loop, formulas", "formulas", kBehind, table7},
                         {"asp2_table_8", kPaper, "table 8",
                          "eigenvalues of the closed loop, numbers", "10 numbers", kBehind, table8},
                         {"asp2_equations_66_73", kPaper, "eqs. 66-73",
                          "closed-loop state matrices", "3 numbers", kBehind, elements}});

}  // namespace
}  // namespace fpc::tool
