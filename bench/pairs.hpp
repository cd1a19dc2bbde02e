// Two things measured in turn in one run: A, B, A, B, ... The ratios of neighbours survive a
// machine that is busy with other things or changes its clock; single times do not.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "base/statistics.hpp"

namespace fpc::bench {

/// How long and how often: 2 s and 10 pairs, or what FMBPC_BENCH_SECONDS and FMBPC_BENCH_PAIRS say.
/// FMBPC_BENCH_ONLY: part of the name of a path; the others are left out.
struct Effort {
  double seconds{2.0};
  int pairs{10};
  std::string only;

  static Effort fromEnvironment() {
    Effort effort;
    if (const char* text = std::getenv("FMBPC_BENCH_SECONDS")) effort.seconds = std::atof(text);
    if (const char* text = std::getenv("FMBPC_BENCH_PAIRS")) effort.pairs = std::atoi(text);
    if (const char* text = std::getenv("FMBPC_BENCH_ONLY")) effort.only = text;
    effort.pairs = std::max(effort.pairs, 1);
    return effort;
  }
};

/// Microseconds of one call, from as many as fill the time.
template <class Work>
double microseconds(const Work& work, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  double passed = 0.0;
  long calls = 0;
  do {
    work();
    ++calls;
    passed = std::chrono::duration<double>(Clock::now() - start).count();
  } while (passed < seconds);
  return 1e6 * passed / static_cast<double>(calls);
}

/// Something of somebody else's that is measured beside ours.
struct Baseline {
  std::string name;
  std::function<void()> work;
};

inline void printRow(const std::string& path, const std::string& baseline, const std::string& aim,
                     const std::vector<double>& ours_us, const std::vector<double>& baseline_us) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours_us.size(); ++i) ratios.push_back(baseline_us[i] / ours_us[i]);
  std::printf(
      "{\"path\": \"%s\", \"baseline\": \"%s\", \"aim\": \"%s\", \"ratio\": %.4g, \"least\": %.4g, "
      "\"most\": %.4g, \"ours_us\": %.5g, \"baseline_us\": %.5g, \"pairs\": %zu}\n",
      path.c_str(), baseline.c_str(), aim.c_str(), median(ratios),
      *std::min_element(ratios.begin(), ratios.end()),
      *std::max_element(ratios.begin(), ratios.end()), median(ours_us), median(baseline_us),
      ratios.size());
  std::fflush(stdout);
}

/// In rounds ours and every baseline once. Prints one line of JSON per baseline: the median, least
/// and most of time(baseline) / time(ours) of the same round, above 1 being in our favour, and the
/// median times of both.
template <class Ours>
void printRounds(const std::string& path, const std::string& aim, const Ours& ours,
                 const std::vector<Baseline>& others, const Effort& effort) {
  if (path.find(effort.only) == std::string::npos) return;
  std::vector<double> ours_us;
  std::vector<std::vector<double>> baseline_us(others.size());
  for (int i = 0; i < effort.pairs; ++i) {
    ours_us.push_back(microseconds(ours, effort.seconds));
    for (std::size_t r = 0; r < others.size(); ++r)
      baseline_us[r].push_back(microseconds(others[r].work, effort.seconds));
  }
  for (std::size_t r = 0; r < others.size(); ++r)
    printRow(path, others[r].name, aim, ours_us, baseline_us[r]);
}

template <class Ours, class Other>
void printPairs(const std::string& path, const std::string& baseline_name, const std::string& aim,
                const Ours& ours, const Other& baseline) {
  printRounds(path, aim, ours, {{baseline_name, baseline}}, Effort::fromEnvironment());
}

}  // namespace fpc::bench
