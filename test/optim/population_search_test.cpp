// Every method on functions whose least value is known, with seeds; budgets; what is refused.
#include "optim/population_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "optim/particle_swarm.hpp"

namespace fpc {
namespace optim_population_search_test {

/// 0 at (0.3, ..., 0.3).
double sphere(const Vector& x) { return (x.array() - 0.3).square().sum(); }
/// 0 at (1, ..., 1).
double rosenbrock(const Vector& x) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i + 1 < x.size(); ++i)
    sum += 100.0 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1.0 - x[i], 2);
  return sum;
}

using Function = double (*)(const Vector&);

Judge judgeOf(Function cost, int threads = 1) {
  return [=](const Matrix& points, Vector& costs) {
    parallelFor(static_cast<std::size_t>(points.cols()), threads, [&](std::size_t p) {
      const auto column = static_cast<Eigen::Index>(p);
      costs[column] = cost(points.col(column));
    });
    return true;
  };
}

SearchParams paramsOf(const std::string& method, int evaluations, std::uint64_t seed = 1) {
  SearchParams params;
  params.method = searchMethod(method);
  params.population = 20;
  params.evaluations = evaluations;
  params.seed = seed;
  return params;
}

SearchResult minimum(Function cost, const SearchParams& params, Eigen::Index n, int threads = 1) {
  return runSearch(params, Vector::Constant(n, -2.0), Vector::Constant(n, 2.0),
                   judgeOf(cost, threads));
}

/// Median over seeds 1..5.
double median(Function cost, const std::string& method, int evaluations, Eigen::Index n) {
  std::vector<double> found;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    found.push_back(minimum(cost, paramsOf(method, evaluations, seed), n).cost);
  std::nth_element(found.begin(), found.begin() + 2, found.end());
  return found[2];
}

class EveryMethod : public ::testing::TestWithParam<std::string> {
 protected:
  /// Where the least cost is 0 the inertia w0 - gbest/pbest stays large and APSO does not settle.
  static double bound(double of_random, double of_apso, double of_others) {
    if (GetParam() == "random") return of_random;
    return GetParam() == "apso" ? of_apso : of_others;
  }
};
INSTANTIATE_TEST_SUITE_P(Search, EveryMethod, ::testing::ValuesIn(searchMethods()),
                         [](const auto& info) { return info.param; });

TEST_P(EveryMethod, FindsTheBottomOfASphereAndRandomSearchOnlyItsNeighbourhood) {
  EXPECT_LT(median(sphere, GetParam(), 2000, 4), bound(1.0, 1e-2, 1e-3));
}

TEST_P(EveryMethod, FindsTheBottomOfASphereThatDoesNotReachZero) {
  const auto raised = [](const Vector& x) { return 1.0 + sphere(x); };
  EXPECT_LT(median(raised, GetParam(), 2000, 4), 1.0 + bound(1.0, 1e-3, 1e-3));
}

TEST_P(EveryMethod, ComesDownTheValleyOfRosenbrock) {
  EXPECT_LT(median(rosenbrock, GetParam(), 4000, 2), bound(0.1, 1e-2, 1e-3));
}

TEST_P(EveryMethod, GivesTheSameBitsForTheSameSeedOnAnyNumberOfThreads) {
  const SearchResult one = minimum(rosenbrock, paramsOf(GetParam(), 300), 3);
  for (const int threads : {2, 4}) {
    const SearchResult other = minimum(rosenbrock, paramsOf(GetParam(), 300), 3, threads);
    EXPECT_EQ(one.best, other.best);
    EXPECT_EQ(one.cost, other.cost);
  }
  EXPECT_NE(one.best, minimum(rosenbrock, paramsOf(GetParam(), 300, 2), 3).best);
}

TEST_P(EveryMethod, UsesItsBudgetExactlyAlsoWhereItIsNoWholeGeneration) {
  for (const int budget : {7, 20, 93}) {
    int calls = 0;
    const auto judge = [&](const Matrix& points, Vector& costs) {
      calls += static_cast<int>(points.cols());
      return judgeOf(sphere)(points, costs);
    };
    const SearchResult found =
        runSearch(paramsOf(GetParam(), budget), Vector::Zero(2), Vector::Ones(2), judge);
    EXPECT_EQ(found.evaluations, budget);
    EXPECT_EQ(calls, budget);
  }
}

TEST_P(EveryMethod, NeverLeavesTheBoxAndAcceptsASideWithoutWidth) {
  const Vector lower = (Vector(3) << -5.0, 2.0, 100.0).finished();
  const Vector upper = (Vector(3) << -4.0, 2.0, 300.0).finished();
  const auto judge = [&](const Matrix& points, Vector& costs) {
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      EXPECT_TRUE((points.col(p).array() >= lower.array()).all());
      EXPECT_TRUE((points.col(p).array() <= upper.array()).all());
      costs[p] = points(2, p) - points(0, p);
    }
    return true;
  };
  const SearchResult found = runSearch(paramsOf(GetParam(), 400), lower, upper, judge);
  EXPECT_LT(found.cost, 104.0 + 10.0);
}

TEST_P(EveryMethod, BeginsAtTheStartAndKeepsItIfNothingIsBetter) {
  const Vector start = Vector::Constant(2, 0.3);
  const SearchResult found =
      runSearch(paramsOf(GetParam(), 40), Vector::Zero(2), Vector::Ones(2), judgeOf(sphere), start);
  EXPECT_EQ(found.best, start);
  EXPECT_EQ(found.cost, 0.0);
}

TEST_P(EveryMethod, LivesWithCostsThatAreInfiniteOrNotANumber) {
  const auto holes = [](const Vector& x) {
    if (x[0] < 0.0) return std::nan("");
    return x[1] < 0.0 ? kInfinity : sphere(x);
  };
  const SearchResult found = minimum(holes, paramsOf(GetParam(), 600), 2);
  EXPECT_LT(found.cost, 0.1);
  const SearchResult none =
      minimum([](const Vector&) { return std::nan(""); }, paramsOf(GetParam(), 100), 2);
  EXPECT_EQ(none.cost, kInfinity);
  EXPECT_EQ(none.evaluations, 100);
}

TEST_P(EveryMethod, StopsWhenTheJudgeDoes) {
  int left = 3;
  const auto judge = [&](const Matrix& points, Vector& costs) {
    return left-- > 0 && judgeOf(sphere)(points, costs);
  };
  const SearchResult found =
      runSearch(paramsOf(GetParam(), 500), Vector::Zero(2), Vector::Ones(2), judge);
  EXPECT_TRUE(found.stopped);
  EXPECT_EQ(found.evaluations, 60);
}

TEST(PopulationSearch, AllMethodsBeginWithTheSameGeneration) {
  const Vector lower = Vector::Zero(3), upper = Vector::Ones(3);
  const Matrix first = makeSearch(paramsOf("apso", 100), lower, upper)->ask();
  for (const auto& method : searchMethods())
    EXPECT_EQ(makeSearch(paramsOf(method, 100), lower, upper)->ask(), first) << method;
}

TEST(PopulationSearch, AdaptiveInertiaComparesTheCommonWithTheOwnBestAndIsGuarded) {
  EXPECT_EQ(Swarm::likeness(2.0, 8.0), 0.25);
  EXPECT_EQ(Swarm::likeness(0.0, 0.0), 1.0);
  EXPECT_EQ(Swarm::likeness(0.0, 5.0), 0.0);
  EXPECT_EQ(Swarm::likeness(-1.0, 0.0), 0.0);
  EXPECT_EQ(Swarm::likeness(3.0, kInfinity), 0.0);
  EXPECT_EQ(Swarm::likeness(kInfinity, kInfinity), 1.0);
  EXPECT_EQ(Swarm::likeness(-4.0, 2.0), 0.0);
  EXPECT_EQ(Swarm::likeness(-8.0, -2.0), 1.0);
}

TEST(PopulationSearch, InertiaOfPsoFallsFromTheFirstToTheLastMove) {
  // Without pulls a particle inside a huge box coasts: each move is the last one times w.
  SwarmParams params;
  params.particles = 1;
  params.iterations = 3;
  params.cognitive = params.social = 0.0;
  params.speed_upper = 1e-6;
  Swarm swarm(Vector::Constant(1, -1e6), Vector::Constant(1, 1e6), params, Vector::Zero(1));
  std::vector<double> place;
  for (int t = 0; t < 4; ++t) {
    place.push_back(swarm.ask()(0, 0));
    swarm.tell(Vector::Zero(1));
  }
  EXPECT_NEAR((place[2] - place[1]) / (place[1] - place[0]), 0.65, 1e-12);
  EXPECT_NEAR((place[3] - place[2]) / (place[2] - place[1]), 0.4, 1e-12);
}

TEST(PopulationSearch, MistakesAreNamed) {
  const auto error = [](const SearchParams& params) {
    try {
      params.validate();
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  EXPECT_THROW(searchMethod("simplex"), InputError);
  for (const std::string& word : searchMethods()) EXPECT_EQ(wordOf(searchMethod(word)), word);
  SearchParams params = paramsOf("apso", 0);
  EXPECT_NE(error(params).find("search.evaluations"), std::string::npos);
  params = paramsOf("apso", 10);
  params.speed_upper = 0.0;
  EXPECT_NE(error(params).find("speed_upper"), std::string::npos);
  for (const auto& method : searchMethods()) {
    params = paramsOf(method, 10);
    params.population = 0;
    EXPECT_NE(error(params).find("search.population"), std::string::npos) << method;
  }
  EXPECT_THROW(makeSearch(paramsOf("random", 10), Vector::Ones(2), Vector::Zero(2)), InputError);
}

}  // namespace optim_population_search_test
}  // namespace fpc
