#include "control/targets/target_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "optim/qp.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kKept = 1e-9;     // of a unit: so little given up is nothing
constexpr double kMargin = 1e-10;  // of a unit: room that a rank leaves to those behind it
constexpr double kRoom = 1e-10;    // of the cost's size: the same for the resting values
constexpr double kFirstRoom = 1e-10, kMostRoom = 1e-7;  // of a unit
constexpr double kPull = 1e-6;  // of the unknowns to where they are: each stage is strictly convex,
constexpr int kPulls = 12;      // and pulls again from where it came until nothing moves
constexpr double kStill = 1e-11;
constexpr double kPushes = 1e-7;  // a multiplier, in units given up, above rounding
constexpr double kOwnWay = 1e-5;  // of a normal: so much of it no other has

template <typename Has>
std::vector<Index> rowsWhere(const std::vector<int>& ranks, const Has& has) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    if (has(ranks[i])) rows.push_back(static_cast<Index>(i));
  return rows;
}

std::vector<Index> allRows(std::size_t count) {
  std::vector<Index> rows(count);
  std::iota(rows.begin(), rows.end(), Index{0});
  return rows;
}

double largest(const Vector& price) { return price.size() > 0 ? price.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

TargetProblem::TargetProblem(Index n, Index m)
    : lower(Vector::Constant(n, -kInfinity)),
      upper(Vector::Constant(n, kInfinity)),
      unit(Vector::Ones(n)),
      rows(Matrix::Zero(m, n)),
      row_lower(Vector::Constant(m, -kInfinity)),
      row_upper(Vector::Constant(m, kInfinity)),
      row_unit(Vector::Ones(m)),
      rank(static_cast<std::size_t>(m), 1),
      price(Vector::Zero(n)),
      rest(Vector::Zero(n)) {}

struct TargetSolver::Workspace {
  /// Rows that one stage gives up, and those of the stages before, which it keeps.
  struct Stage {
    std::vector<Index> soft, hard;
    QpProblem qp;  // in v / unit, then what is given up of each soft row over its unit
    QpSolver solver;

    Stage(Index n, std::vector<Index> soft_rows, std::vector<Index> hard_rows)
        : soft(std::move(soft_rows)),
          hard(std::move(hard_rows)),
          qp(n + static_cast<Index>(soft.size()), static_cast<Index>(soft.size() + hard.size())),
          solver(std::max<Index>(qp.g.size(), 1), qp.a_lower.size()) {
      qp.H.diagonal().head(n).setConstant(kPull);
      for (Index k = 0; k < static_cast<Index>(soft.size()); ++k) qp.A(k, n + k) = -1.0;
    }
  };

  Index n, m;
  std::vector<int> ranks;
  Stage together;             // all rows at once: enough where all can be kept
  std::vector<Stage> stages;  // by rank
  Stage money, resting;       // resting: a last row for the cost
  Matrix rows;                // in units
  Vector lower, upper;        // of the rows in units, as far as they are kept
  Vector price, x, level, level_x;
  Matrix fixed;  // orthonormal columns: ways in which no later stage can move
  Index n_fixed{};
  Vector normal;
  const QpResult* last{};  // of run()
  bool all_kept{true};
  TargetSolution solution;

  Workspace(Index count, std::vector<int> ranks_of_rows)
      : n(count),
        m(static_cast<Index>(ranks_of_rows.size())),
        ranks(std::move(ranks_of_rows)),
        together(n, allRows(ranks.size()), {}),
        money(n, {}, allRows(ranks.size())),
        resting(n, {}, allRows(ranks.size() + 1)),
        rows(m, n),
        lower(m),
        upper(m),
        price(n),
        x(Vector::Zero(n)),
        level(m),
        level_x(n),
        fixed(n, n),
        normal(n) {
    std::vector<int> distinct = ranks;
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    for (const int rank : distinct)
      stages.emplace_back(n, rowsWhere(ranks, [&](int r) { return r == rank; }),
                          rowsWhere(ranks, [&](int r) { return r < rank; }));
    resting.qp.H.diagonal().setOnes();
    solution.v = Vector::Zero(n);
    solution.given_up = Vector::Zero(m);
  }

  static bool valid(const TargetProblem& p) {
    return !p.lower.hasNaN() && !p.upper.hasNaN() && !p.row_lower.hasNaN() &&
           !p.row_upper.hasNaN() && p.rows.allFinite() && p.price.allFinite() &&
           p.rest.allFinite() && (p.lower.array() <= p.upper.array()).all() &&
           (p.row_lower.array() <= p.row_upper.array()).all();
  }

  void put(const TargetProblem& p, Stage& stage) const {
    QpProblem& qp = stage.qp;
    qp.x_lower.head(n) = p.lower.cwiseQuotient(p.unit);
    qp.x_upper.head(n) = p.upper.cwiseQuotient(p.unit);
    Index at = 0;
    for (const auto* list : {&stage.soft, &stage.hard})
      for (const Index row : *list) {
        if (row == m) continue;  // of the cost
        qp.A.row(at).head(n) = rows.row(row);
        qp.a_lower[at] = lower[row];
        qp.a_upper[at++] = upper[row];
      }
  }

  /// Rows that must hold meet in corners that only rounding can miss: one that is missed is opened
  /// a little, and what is opened stays far below what counts as given up.
  bool run(Stage& stage) {
    for (double room = 0.0; room <= kMostRoom; room = room == 0.0 ? kFirstRoom : 10.0 * room) {
      const auto first = static_cast<Index>(stage.soft.size());
      if (room > 0.0) {
        stage.qp.a_lower.tail(stage.qp.a_lower.size() - first).array() -= room;
        stage.qp.a_upper.tail(stage.qp.a_upper.size() - first).array() += room;
      }
      const QpResult& result = stage.solver.solve(stage.qp);
      solution.status = result.status;
      last = &result;
      if (!result.usable()) continue;
      x = result.x.head(n);
      return true;
    }
    return false;
  }

  /// Proximal points: exact after few, as the cost is linear or quadratic on a polyhedron.
  bool pull(Stage& stage, const Vector* gradient) {
    for (int i = 0; i < kPulls; ++i) {
      stage.qp.g.head(n) = -kPull * x;
      if (gradient) stage.qp.g.head(n) += *gradient;
      level_x = x;
      if (!run(stage)) return false;
      if ((x - level_x).cwiseAbs().maxCoeff() <= kStill) break;
    }
    return true;
  }

  /// Adds the part of `normal` that lies in no fixed way yet.
  void fixNormal() {
    const double size = normal.norm();
    for (int twice = 0; twice < 2; ++twice)
      for (Index k = 0; k < n_fixed; ++k) normal -= fixed.col(k).dot(normal) * fixed.col(k);
    const double own = normal.norm();
    if (n_fixed < n && own > kOwnWay * size) fixed.col(n_fixed++) = normal / own;
  }

  /// A limit with a multiplier is active in every answer of its stage, and each answer gives up the
  /// same of each row. @return whether that leaves x no freedom: later stages would find it again
  bool leavesNothing(const Stage& stage) {
    for (Index j = 0; j < n; ++j) {
      if (std::abs(last->y_x[j]) <= kPushes) continue;
      normal = Vector::Unit(n, j);
      fixNormal();
    }
    Index at = 0;
    for (const auto* list : {&stage.soft, &stage.hard})
      for (const Index row : *list) {
        if (std::abs(last->y_a[at++]) <= kPushes) continue;
        normal = rows.row(row).transpose();
        fixNormal();
      }
    return n_fixed == n;
  }

  /// Keeps these rows as they are found at x, or within their limits.
  void keep(const std::vector<Index>& which) {
    for (const Index row : which) {
      const double at = rows.row(row).dot(x);
      lower[row] = std::min(lower[row], at - kMargin);
      upper[row] = std::max(upper[row], at + kMargin);
    }
  }

  /// The ranked limits; afterwards lower and upper can all be kept together.
  bool rank(const TargetProblem& p) {
    n_fixed = 0;
    if (m == 0) {
      x = p.rest.cwiseQuotient(p.unit);
      return true;
    }
    if (all_kept) {
      put(p, together);
      if (!pull(together, nullptr)) return false;
      all_kept = farthest(together.soft) <= kKept;
      if (all_kept) {
        keep(together.soft);
        return true;
      }
    }
    all_kept = true;
    for (Stage& stage : stages) {
      put(p, stage);
      if (!pull(stage, nullptr)) return false;
      all_kept = all_kept && farthest(stage.soft) <= kKept;
      if (leavesNothing(stage)) return true;
      keep(stage.soft);
    }
    return true;
  }

  /// What is given up of these rows at x, in units, as the limits are now.
  double farthest(const std::vector<Index>& which) const {
    double most = 0.0;
    for (const Index row : which) {
      const double at = rows.row(row).dot(x);
      most = std::max({most, lower[row] - at, at - upper[row]});
    }
    return most;
  }

  bool leastCost(const TargetProblem& p) {
    price = p.price.cwiseProduct(p.unit);
    const double size = largest(price);
    if (size == 0.0) return true;
    put(p, money);
    price /= size;
    const bool done = pull(money, &price);
    price *= size;
    return done;
  }

  bool rest(const TargetProblem& p) {
    put(p, resting);
    QpProblem& qp = resting.qp;
    qp.g = -p.rest.cwiseQuotient(p.unit);
    const double size = largest(price);
    qp.a_lower[m] = -kInfinity;
    qp.a_upper[m] = kInfinity;
    qp.A.row(m).setZero();
    if (size > 0.0) {
      qp.A.row(m) = price.transpose() / size;
      const double terms = 1.0 + (price / size).cwiseProduct(x).cwiseAbs().maxCoeff();
      qp.a_upper[m] = price.dot(x) / size + p.band / size + kRoom * terms;
    }
    return run(resting);
  }

  void conclude(const TargetProblem& p) {
    solution.v = x.cwiseProduct(p.unit).cwiseMax(p.lower).cwiseMin(p.upper);
    solution.cost = p.price.dot(solution.v);
    level.noalias() = p.rows * solution.v;
    for (Index i = 0; i < m; ++i) {
      const double kept = kKept * 10.0 * p.row_unit[i];
      double& beyond = solution.given_up[i] = 0.0;
      if (level[i] > p.row_upper[i] + kept) beyond = level[i] - p.row_upper[i];
      if (level[i] < p.row_lower[i] - kept) beyond = level[i] - p.row_lower[i];
    }
  }
};

TargetSolver::TargetSolver(Index n, std::vector<int> ranks)
    : work_(std::make_unique<Workspace>(n, std::move(ranks))) {}
TargetSolver::~TargetSolver() = default;
TargetSolver::TargetSolver(TargetSolver&&) noexcept = default;

const TargetSolution& TargetSolver::solve(const TargetProblem& p) {
  Workspace& w = *work_;
  w.solution.status = SolveStatus::kInvalidProblem;
  if (!Workspace::valid(p)) return w.solution;
  for (Index i = 0; i < w.m; ++i) {
    w.rows.row(i) = p.rows.row(i).cwiseProduct(p.unit.transpose()) / p.row_unit[i];
    w.lower[i] = p.row_lower[i] / p.row_unit[i];
    w.upper[i] = p.row_upper[i] / p.row_unit[i];
  }
  if (!w.rank(p)) return w.solution;
  const bool free = w.n_fixed < w.n;
  if (free && !w.leastCost(p)) return w.solution;
  w.solution.least_cost = p.price.dot(w.x.cwiseProduct(p.unit));
  if (free && !w.rest(p)) w.solution.status = SolveStatus::kSolved;  // x is still the cheapest
  w.conclude(p);
  return w.solution;
}

const TargetSolution& TargetSolver::solution() const { return work_->solution; }

}  // namespace fpc
