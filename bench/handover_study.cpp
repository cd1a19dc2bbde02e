// The whole study of shadow and hand-over: bench/handover_study [CASES OF EACH KIND AND PLANT]
// [FIRST SEED] [PLANT] [NUMBER OF THE KIND]. Prints one row for each kind and plant, and what
// became of cases that went otherwise than asked; of one kind, what became of all.
#include "handover_study.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "paths.hpp"

namespace fpc::bench {
namespace {

void row(const StudyPlant& plant, Spoil spoil, int cases, std::uint64_t first, bool talks) {
  int handed = 0, kept = 0, refused = 0, back = 0;
  double bump = 0.0, bump_back = 0.0, after = 0.0;
  for (int i = 0; i < cases; ++i) {
    const CaseResult r = runCase(sourceDir(), plant, spoil, first + static_cast<std::uint64_t>(i));
    handed += r.handed_over ? 1 : 0;
    kept += r.state == CandidateState::kInCharge ? 1 : 0;
    refused += r.state == CandidateState::kRefused ? 1 : 0;
    back += r.back_at > 0 ? 1 : 0;
    bump = std::max(bump, r.bump);
    bump_back = std::max(bump_back, r.bump_back);
    if (r.back_at > 0) after = std::max(after, r.after_back);
    const bool asked = spoil == Spoil::kSwings ||
                       (spoil == Spoil::kNone) == (r.state == CandidateState::kInCharge);
    if (!asked || talks)
      std::printf("  seed %d: %u..%u %s\n", static_cast<int>(first) + i, r.handed_at, r.back_at,
                  r.report.c_str());
  }
  std::printf("%-8s %-28s %4d %6d %6d %7d %5d %7.2f %9.2f %10.2f\n", plant.name, nameOf(spoil),
              cases, handed, kept, refused, back, bump, bump_back, after);
  std::fflush(stdout);
}

}  // namespace
}  // namespace fpc::bench

int main(int argc, char** argv) {
  using namespace fpc::bench;
  const int cases = argc > 1 ? std::atoi(argv[1]) : 25;
  const auto first = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  const std::string only = argc > 3 ? argv[3] : "";
  const int only_spoil = argc > 4 ? std::atoi(argv[4]) : -1;
  std::printf("%-8s %-28s %4s %6s %6s %7s %5s %7s %9s %10s\n", "plant", "candidate", "n", "handed",
              "kept", "refused", "back", "bump", "bump back", "after back");
  for (const StudyPlant& plant : studyPlants()) {
    if (!only.empty() && only != plant.name) continue;
    for (int s = 0; s <= static_cast<int>(Spoil::kSwings); ++s) {
      if (only_spoil >= 0 && s != only_spoil) continue;
      const auto spoil = static_cast<Spoil>(s);
      const bool of_spoilt = spoil != Spoil::kNone && spoil != Spoil::kSwings;
      row(plant, spoil, of_spoilt ? std::max(1, cases / 5) : cases, first, only_spoil >= 0);
    }
  }
  return 0;
}
