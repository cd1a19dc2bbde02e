// How the time of a step grows with the size of the problem: outputs and inputs, rules, horizon,
// perturbations, states. One line of JSON per point, the least of three rounds over all points, so
// that a busy moment spoils none; scripts/bench fits exponents and draws.
#include <time.h>

#include <functional>
#include <memory>
#include <vector>

#include "growth_cases.hpp"
#include "pairs.hpp"
#include "plant/integrator.hpp"

namespace fpc::bench {
namespace {

struct Point {
  const char* curve;
  int size;
  std::function<void()> work;
  double least_us{std::numeric_limits<double>::infinity()};
};

void addLaws(std::vector<Point>& points) {
  const auto add = [&](const char* curve, int size, int outputs, int rules, int horizon) {
    auto law = std::make_shared<LawCase>(outputs, rules, horizon);
    points.push_back({curve, size, [law] { law->step(); }});
  };
  for (const int n : {1, 2, 4, 8, 15, 30}) add("law, outputs = inputs", n, n, 6, 6);
  for (const int rules : {2, 4, 8, 16, 32, 64}) add("law, rules of 2 outputs", rules, 2, rules, 6);
  for (const int H : {3, 12, 48, 192, 768}) add("law, coincidence horizon", H, 2, 6, H);
}

void addClp(std::vector<Point>& points) {
  const auto add = [&](const char* curve, int size, int inputs, int steps, bool warm) {
    auto clp = std::make_shared<ClpCase>(inputs, steps);
    points.push_back({curve, size, [clp, warm] { clp->step(warm); }});
  };
  for (const bool warm : {false, true}) {
    for (const int n_c : {5, 10, 20, 50, 100, 200})
      add(warm ? "CLP warm, n_c" : "CLP cold, n_c", n_c, 1, n_c, warm);
    for (const int n : {1, 2, 4, 8, 15, 30})
      add(warm ? "CLP warm, outputs = inputs (n_c 5)" : "CLP cold, outputs = inputs (n_c 5)", n, n,
          5, warm);
  }
}

/// A sample of a chain of tanks from rest with the inflow stepped.
struct PlantCase {
  explicit PlantCase(int tanks)
      : plant(tanks), integrator(plant, stiffParams()), x(Vector::Ones(tanks)) {}
  static IntegratorParams stiffParams() {
    IntegratorParams params;
    params.relative_tolerance = params.absolute_tolerance = 1e-6;
    params.max_steps = 100000;
    return params;
  }
  void step() {
    x.setOnes();
    integrator.advance(x, Vector::Constant(1, 1.1), Vector(), 10.0);
  }
  TankChain plant;
  Integrator integrator;
  Vector x;
};

void addPlants(std::vector<Point>& points) {
  for (const int n : {2, 5, 10, 20, 50, 100, 200, 500}) {
    auto plant = std::make_shared<PlantCase>(n);
    points.push_back({"plant sample, tanks in a chain", n, [plant] { plant->step(); }});
  }
}

/// CPU time of this thread [us]: a process that is put aside spoils no percentile.
double threadMicroseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// Median and 99th percentile of single CLP steps, n_c 42, warm.
void printSpread(double seconds) {
  ClpCase clp(1, 42);
  std::vector<double> times;
  const double begin = threadMicroseconds();
  for (double now = begin; times.size() < 100 || now - begin < 1e6 * seconds;) {
    clp.step(true);
    const double then = threadMicroseconds();
    times.push_back(then - now);
    now = then;
  }
  std::sort(times.begin(), times.end());
  std::printf(
      "{\"spread\": \"CLP step, n_c 42, bounds and moves, warm\", \"median_us\": %.5g, \"p99_us\": "
      "%.5g, "
      "\"steps\": %zu, \"unsolved\": %d}\n",
      times[times.size() / 2], times[times.size() * 99 / 100], times.size(), clp.unsolved);
}

}  // namespace
}  // namespace fpc::bench

int main() {
  using namespace fpc::bench;
  std::vector<Point> points;
  addLaws(points);
  addClp(points);
  addPlants(points);
  const Effort effort = Effort::fromEnvironment();
  const int rounds = effort.pairs > 1 ? 3 : 1;
  for (int round = 0; round < rounds; ++round)
    for (Point& point : points) {
      const double us = microseconds(point.work, 0.05 * effort.seconds);
      point.least_us = std::min(point.least_us, us);
    }
  for (const Point& point : points)
    std::printf("{\"curve\": \"%s\", \"size\": %d, \"us\": %.5g}\n", point.curve, point.size,
                point.least_us);
  printSpread(effort.seconds);
  return 0;
}
