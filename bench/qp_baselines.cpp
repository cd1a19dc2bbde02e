// Our QP solver beside others' in one run: the public MPC set (with FMBPC_DATA) and a controller's
// problems of 42 inputs, cold with a new Hessian each time and warm. One line of JSON per pair; a
// family's time is that of one pass over its problems.
#include <cmath>
#include <limits>

#include "baselines/baseline_qp.hpp"
#include "optim/mpc_qp_set.hpp"
#include "optim/qp_problems.hpp"
#include "pairs.hpp"

namespace fpc::bench {
namespace {

using testing::ControllerQp;

struct Family {
  std::string name, aim;
  std::vector<QpProblem> problems;
};

/// Two copies of a problem in turn, the Hessians a rounding apart, so that nothing is reused that a
/// new Hessian would not allow.
class Ours {
 public:
  explicit Ours(const QpProblem& p) : solver_(p.g.size(), p.a_lower.size()), problems_{p, p} {
    problems_[1].H *= 1.0 + 1e-15;
  }
  const QpResult& solve(bool warm) {
    turn_ = 1 - turn_;
    return solver_.solve(problems_[turn_], warm);
  }

 private:
  QpSolver solver_;
  QpProblem problems_[2];
  std::size_t turn_{};
};

double costOf(const QpProblem& p, const Vector& x) { return 0.5 * x.dot(p.H * x) + p.g.dot(x); }

/// Largest violation of a limit, relative to 1 + |x|, and how far the cost is from ours. (Where the
/// Hessian is semidefinite there may be many answers.)
double errorOf(const QpProblem& p, const Vector& x, const Vector& ours) {
  double violation = 0.0;
  const Vector Ax = p.A * x;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    violation = std::max({violation, p.x_lower(i) - x(i), x(i) - p.x_upper(i)});
  for (Eigen::Index i = 0; i < Ax.size(); ++i)
    violation = std::max({violation, p.a_lower(i) - Ax(i), Ax(i) - p.a_upper(i)});
  const double cost = costOf(p, ours);
  return std::max(violation / (1.0 + ours.lpNorm<Eigen::Infinity>()),
                  std::abs(costOf(p, x) - cost) / (1.0 + std::abs(cost)));
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.0e", value);
  return buffer;
}

void compare(const Family& family, const BaselineType& type, bool warm) {
  std::vector<Ours> ours;
  std::vector<std::unique_ptr<BaselineQp>> theirs;
  int solved = 0, solved_by_baseline = 0;
  double worst = 0.0;
  for (const QpProblem& p : family.problems) {
    ours.emplace_back(p);
    theirs.push_back(type.make());
    theirs.back()->prepare(p);
    const QpResult& r = ours.back().solve(false);
    solved += r.usable() && r.kkt_residual <= 1e-9;
    const bool claims = theirs.back()->solve();
    const double error = errorOf(p, theirs.back()->x(), r.x);
    worst = std::max(worst, error);
    solved_by_baseline += claims && error <= 1e-6;
  }
  const auto count = std::to_string(family.problems.size());
  const std::string path = "QP " + family.name + (warm ? ", warm" : ", cold") + " (" +
                           std::to_string(solved) + " of " + count + " solved)";
  const std::string baseline = type.name + " (" + std::to_string(solved_by_baseline) + " of " +
                               count + ", error " + text(worst) + ")";
  printPairs(
      path, baseline, family.aim,
      [&] {
        for (Ours& one : ours) one.solve(warm);
      },
      [&] {
        for (auto& one : theirs) warm ? one->solveWarm() : one->solve();
      });
}

Family controllerFamily(ControllerQp::Kind kind, const std::string& name) {
  Family family{name, "1.25", {}};
  for (int i = 0; i < 20; ++i) {
    ControllerQp controller(kind);
    controller.update(0.37 * i);
    family.problems.push_back(controller.problem);
  }
  return family;
}

std::vector<Family> families() {
  using Kind = ControllerQp::Kind;
  std::vector<Family> all{controllerFamily(Kind::kBounds, "n_c 42, bounds"),
                          controllerFamily(Kind::kMoves, "n_c 42, + move rows"),
                          controllerFamily(Kind::kOutputs, "n_c 42, + soft outputs")};
  const char* data = std::getenv("FMBPC_DATA");
  if (data == nullptr) return all;
  const auto folder = std::filesystem::path(data) / "mpc_qp";
  if (!std::filesystem::is_directory(folder)) return all;
  for (const std::string name : {"LIPMWALK", "WHLIPBAL", "QUADCMPC"}) {
    Family family{name, "1", {}};
    for (const auto& [file, arrays] : testing::readMpcQpSet(folder, name))
      family.problems.push_back(testing::toProblem(arrays));
    if (!family.problems.empty()) all.push_back(family);
  }
  return all;
}

}  // namespace
}  // namespace fpc::bench

int main() {
  using namespace fpc::bench;
  for (const Family& family : families()) {
    for (const BaselineType& type : baselines()) {
      compare(family, type, false);
      if (type.make()->canWarm()) compare(family, type, true);
    }
  }
  return 0;
}
