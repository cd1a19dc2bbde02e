// pagmo2 evaluates one point after the other inside evolve(). So each generation is played twice
// from the same state: a rehearsal on a copy, which only notes the points, and, when all of them
// have been judged elsewhere, the real one, which looks the costs up. This works because neither
// method lets the costs of a generation decide which points the same generation asks.
#include "optim/pagmo_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <stdexcept>

namespace fpc {
namespace {

constexpr double kWorst = std::numeric_limits<double>::max();  // an infinite cost, for pagmo

/// The points of one generation and, in the real one, their costs.
struct Book {
  std::vector<pagmo::vector_double> points;
  std::vector<double> costs;  // empty: rehearsal
  std::size_t next{};
};

/// The problem that pagmo is given to minimise, over the unit box.
class BookProblem {
 public:
  BookProblem() = default;
  BookProblem(std::size_t dimension, std::shared_ptr<Book> book)
      : dimension_(dimension), book_(std::move(book)) {}

  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    if (book_->costs.empty()) {
      book_->points.push_back(x);
      return {kWorst};
    }
    const std::size_t i = book_->next++;
    if (i >= book_->costs.size() || book_->points[i] != x)
      throw std::logic_error("pagmo: a generation asked other points than its rehearsal");
    return {book_->costs[i]};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(dimension_, 0.0), pagmo::vector_double(dimension_, 1.0)};
  }

 private:
  std::size_t dimension_{1};
  std::shared_ptr<Book> book_;
};

pagmo::algorithm algorithmOf(const SearchParams& params) {
  const auto seed = static_cast<unsigned>(params.seed ^ (params.seed >> 32U));
  if (params.method == SearchMethod::kDe)
    return pagmo::algorithm(pagmo::de(1, params.differential_weight, params.crossover,
                                      static_cast<unsigned>(params.variant), 0.0, 0.0, seed));
  return pagmo::algorithm(pagmo::cmaes(1, -1, -1, -1, -1, params.step, 0.0, 0.0, true, true, seed));
}

class PagmoSearch : public PopulationSearch {
 public:
  PagmoSearch(const SearchParams& params, const Matrix& first, const Vector& lower,
              const Vector& upper)
      : lower_(lower),
        range_(upper - lower),
        first_(first),
        book_(std::make_shared<Book>()),
        algorithm_(algorithmOf(params)),
        population_(pagmo::problem(BookProblem(static_cast<std::size_t>(lower.size()), book_)), 0U,
                    static_cast<unsigned>(params.seed)) {}

  Matrix ask() override {
    if (population_.size() == 0) return first_;
    *book_ = {};
    const pagmo::algorithm rehearsal = algorithm_;
    rehearsal.evolve(population_);
    Matrix points(lower_.size(), static_cast<Eigen::Index>(book_->points.size()));
    for (Eigen::Index p = 0; p < points.cols(); ++p)
      points.col(p) = outOfUnit(book_->points[static_cast<std::size_t>(p)]);
    return points;
  }

  void tell(const Vector& costs) override {
    std::vector<double> finite;
    for (const double cost : costs) finite.push_back(cost < kWorst ? cost : kWorst);
    if (population_.size() == 0) {
      for (Eigen::Index p = 0; p < first_.cols(); ++p)
        population_.push_back(intoUnit(first_.col(p)), {finite[static_cast<std::size_t>(p)]});
      return;
    }
    book_->costs = finite;
    population_ = algorithm_.evolve(population_);
  }

 private:
  Vector outOfUnit(const pagmo::vector_double& x) const {
    const Eigen::Map<const Vector> unit(x.data(), lower_.size());
    return (lower_ + unit.cwiseProduct(range_)).cwiseMax(lower_).cwiseMin(lower_ + range_);
  }
  pagmo::vector_double intoUnit(const Vector& point) const {
    pagmo::vector_double unit;
    for (Eigen::Index i = 0; i < point.size(); ++i)
      unit.push_back(range_[i] > 0.0 ? std::clamp((point[i] - lower_[i]) / range_[i], 0.0, 1.0)
                                     : 0.5);
    return unit;
  }

  Vector lower_, range_;
  Matrix first_;
  std::shared_ptr<Book> book_;
  pagmo::algorithm algorithm_;
  pagmo::population population_;
};

std::unique_ptr<PopulationSearch> make(const SearchParams& params, const Matrix& first,
                                       const Vector& lower, const Vector& upper) {
  return std::make_unique<PagmoSearch>(params, first, lower, upper);
}

const bool kRegistered = registerPagmo(&make);

}  // namespace
}  // namespace fpc
