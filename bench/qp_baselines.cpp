// Our QP solver beside others' in one run: the public MPC set (with FMBPC_DATA) and a controller's
// problems of 42 inputs, cold and warm with a new Hessian each time, and warm with the same. One
// line of JSON per pair; a family's time is that of one pass over its problems.
#include <algorithm>
#include <cmath>
#include <limits>

#include "baselines/baseline_qp.hpp"
#include "baselines/judge.hpp"
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

enum class Mode { kCold, kWarm, kSameHessian };

std::string nameOf(Mode mode) {
  return mode == Mode::kCold ? ", cold" : mode == Mode::kWarm ? ", warm" : ", warm, same Hessian";
}

/// Two copies of a problem in turn, the Hessians a rounding apart, so that nothing is reused that a
/// new Hessian would not allow; or one of them again and again.
class Ours {
 public:
  explicit Ours(const QpProblem& p) : solver_(p.g.size(), p.a_lower.size()), problems_{p, p} {
    problems_[1].H *= 1.0 + 1e-15;
  }
  const QpResult& solve(Mode mode) {
    if (mode != Mode::kSameHessian) turn_ = 1 - turn_;
    return solver_.solve(problems_[turn_], mode != Mode::kCold);
  }

 private:
  QpSolver solver_;
  QpProblem problems_[2];
  std::size_t turn_{};
};

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.0e", value);
  return buffer;
}

/// A solver of somebody else's on all problems of a family.
class Beside {
 public:
  Beside(const Family& family, const BaselineType& type) : name_(type.name) {
    for (const QpProblem& p : family.problems) {
      solvers_.push_back(type.make());
      solvers_.back()->prepare(p);
    }
  }
  /// Solves all as a pass does and says how well, beside our answers.
  std::string judge(const Family& family, Mode mode, const std::vector<Vector>& ours) {
    int solved = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < solvers_.size(); ++i) {
      bool claims = solvers_[i]->solve();
      if (mode != Mode::kCold) claims = solveOne(*solvers_[i], mode);
      const double error = errorOf(family.problems[i], solvers_[i]->x(), ours[i]);
      worst = std::max(worst, error);
      solved += claims && error <= 1e-6;
    }
    return name_ + " (" + std::to_string(solved) + " of " + std::to_string(solvers_.size()) +
           ", error " + text(worst) + ")";
  }
  bool canWarm() const { return solvers_.front()->canWarm(); }
  void pass(Mode mode) {
    for (auto& one : solvers_) solveOne(*one, mode);
  }

 private:
  static bool solveOne(BaselineQp& one, Mode mode) {
    return mode == Mode::kCold ? one.solve() : one.solveWarm(mode == Mode::kWarm);
  }

  std::string name_;
  std::vector<std::unique_ptr<BaselineQp>> solvers_;
};

bool canTakeAll(const BaselineType& type, const Family& family) {
  const auto one = type.make();
  return std::all_of(family.problems.begin(), family.problems.end(),
                     [&](const QpProblem& p) { return one->canTake(p); });
}

void compare(const Family& family, Mode mode) {
  std::vector<Ours> ours;
  std::vector<Vector> answers;
  int solved = 0;
  for (const QpProblem& p : family.problems) {
    ours.emplace_back(p);
    const QpResult* r = &ours.back().solve(Mode::kCold);
    answers.push_back(r->x);
    if (mode != Mode::kCold) r = &ours.back().solve(mode);
    solved += r->usable() && r->kkt_residual <= 1e-9;
  }
  if (mode == Mode::kCold)
    std::printf("{\"family\": \"%s\", \"solved\": %d, \"problems\": %zu}\n", family.name.c_str(),
                solved, family.problems.size());
  std::vector<Baseline> others;
  for (const BaselineType& type : baselines()) {
    if (!canTakeAll(type, family)) continue;
    const auto beside = std::make_shared<Beside>(family, type);
    if (mode != Mode::kCold && !beside->canWarm()) continue;
    others.push_back(
        {beside->judge(family, mode, answers), [beside, mode] { beside->pass(mode); }});
  }
  Effort effort = Effort::fromEnvironment();
  effort.seconds *= 0.5;  // hundreds of passes all the same
  printRounds(
      "QP " + family.name + nameOf(mode) + " (" + std::to_string(solved) + " of " +
          std::to_string(family.problems.size()) + " solved)",
      family.aim,
      [&] {
        for (Ours& one : ours) one.solve(mode);
      },
      others, effort);
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
  for (const Family& family : families())
    for (const Mode mode : {Mode::kCold, Mode::kWarm, Mode::kSameHessian}) compare(family, mode);
  return 0;
}
