#include "optim/population_search.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "optim/pagmo_search.hpp"
#include "optim/particle_swarm.hpp"

namespace fpc {
namespace {

/// Uniform points for ever.
class RandomSearch : public PopulationSearch {
 public:
  RandomSearch(const Matrix& first, const Vector& lower, const Vector& upper, std::uint64_t seed)
      : points_(first), lower_(lower), range_(upper - lower), engine_(seededEngine(seed, {1})) {}

  Matrix ask() override {
    const Matrix now = points_;
    for (Eigen::Index p = 0; p < points_.cols(); ++p)
      for (Eigen::Index i = 0; i < points_.rows(); ++i)
        points_(i, p) = lower_[i] + uniform(engine_) * range_[i];
    return now;
  }
  void tell(const Vector&) override {}

 private:
  Matrix points_;
  Vector lower_, range_;
  std::mt19937_64 engine_;
};

constexpr SearchMethod kMethods[] = {SearchMethod::kApso, SearchMethod::kPso, SearchMethod::kRandom,
                                     SearchMethod::kDe, SearchMethod::kCmaes};

bool needsPagmo(SearchMethod method) {
  return method == SearchMethod::kDe || method == SearchMethod::kCmaes;
}

int generationsOf(const SearchParams& params) {
  return (params.evaluations + params.population - 1) / params.population;
}

SwarmParams swarmOf(const SearchParams& params) {
  SwarmParams swarm;
  swarm.particles = params.population;
  swarm.iterations = generationsOf(params) - 1;
  swarm.inertia_start = params.inertia_start;
  swarm.inertia_end = params.inertia_end;
  swarm.cognitive = params.cognitive;
  swarm.social = params.social;
  swarm.speed_upper = params.speed_upper;
  swarm.seed = params.seed;
  swarm.adaptive = params.method == SearchMethod::kApso;
  swarm.adaptive_inertia = params.inertia;
  return swarm;
}

}  // namespace

std::vector<std::string> searchMethods() {
  std::vector<std::string> methods;
  for (const SearchMethod method : kMethods)
    if (hasPagmo() || !needsPagmo(method)) methods.push_back(wordOf(method));
  return methods;
}

SearchMethod searchMethod(const std::string& word) {
  const auto methods = searchMethods();
  const std::string missing = missingMethods();
  require(std::find(methods.begin(), methods.end(), word) != methods.end(), "search.method",
          "one of " + join(methods) + (missing.empty() ? "" : " (" + missing + ")") + ", got '" +
              word + "'");
  return *std::find_if(std::begin(kMethods), std::end(kMethods),
                       [&](SearchMethod method) { return wordOf(method) == word; });
}

std::string missingMethods() {
  return hasPagmo() ? ""
                    : "de and cmaes need pagmo2, which was not there when this was built "
                      "(Debian: libpagmo-dev)";
}

void SearchParams::validate() const {
  searchMethod(wordOf(method));  // one that this build has
  const int least = needsPagmo(method) ? kPagmoPopulation : 1;
  require(population >= least, "search.population",
          "an integer >= " + std::to_string(least) + " for method " + wordOf(method));
  require(evaluations >= 1, "search.evaluations", "an integer >= 1");
  require(differential_weight >= 0.0 && differential_weight <= 1.0, "search.differential_weight",
          "a number in [0, 1]");
  require(crossover >= 0.0 && crossover <= 1.0, "search.crossover", "a number in [0, 1]");
  require(variant >= 1 && variant <= 10, "search.variant", "an integer in 1..10");
  require(std::isfinite(step) && step > 0.0, "search.step", "a finite number > 0");
  swarmOf(*this).validate();
}

std::unique_ptr<PopulationSearch> makeSearch(const SearchParams& params, const Vector& lower,
                                             const Vector& upper, const Vector& start) {
  params.validate();
  auto swarm = std::make_unique<Swarm>(lower, upper, swarmOf(params), start);
  if (params.method == SearchMethod::kApso || params.method == SearchMethod::kPso) return swarm;
  const Matrix first = swarm->ask();
  if (params.method == SearchMethod::kRandom)
    return std::make_unique<RandomSearch>(first, lower, upper, params.seed);
  return makePagmoSearch(params, first, lower, upper);
}

SearchResult runSearch(const SearchParams& params, const Vector& lower, const Vector& upper,
                       const Judge& judge, const Vector& start) {
  const auto search = makeSearch(params, lower, upper, start);
  SearchResult result;
  result.cost = kInfinity;
  while (result.evaluations < params.evaluations) {
    Matrix points = search->ask();
    if (points.cols() == 0) break;
    const Eigen::Index left = params.evaluations - result.evaluations;
    const bool last = points.cols() >= left;
    if (points.cols() > left) points = points.leftCols(left).eval();
    if (result.evaluations == 0) result.best = points.col(0);
    Vector costs(points.cols());
    if (!judge(points, costs)) {
      result.stopped = true;
      break;
    }
    costs = costs.unaryExpr([](double c) { return std::isnan(c) ? kInfinity : c; });
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      if (!(costs[p] < result.cost)) continue;
      result.cost = costs[p];
      result.best = points.col(p);
    }
    result.evaluations += static_cast<int>(points.cols());
    ++result.generations;
    if (!last) search->tell(costs);
  }
  return result;
}

}  // namespace fpc
