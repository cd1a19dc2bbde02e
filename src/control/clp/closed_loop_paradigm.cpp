#include "control/clp/closed_loop_paradigm.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "control/clp/cost.hpp"
#include "control/clp/limits.hpp"
#include "control/clp/params.hpp"
#include "control/clp/prediction.hpp"
#include "control/clp/steady_target.hpp"
#include "control/clp/terminal_weight.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

bool sameSize(const Matrix& value, Eigen::Index rows, Eigen::Index columns) {
  return value.rows() == rows && value.cols() == columns;
}

// Compared before a message is made: require() would build its strings at every sample.
void checkSizes(const PredictiveAction& now, const ClpSizes& s) {
  const auto refuse = [](const char* field) {
    throw InputError(std::string(field) + ": expected the size given at construction");
  };
  if (now.state.size() != s.n_x) refuse("predictive_action.state");
  if (!sameSize(now.A, s.n_x, s.n_x)) refuse("predictive_action.A");
  if (!sameSize(now.B, s.n_x, s.n_u)) refuse("predictive_action.B");
  if (!sameSize(now.C, s.n_y, s.n_x)) refuse("predictive_action.C");
  if (now.offset_state.size() != s.n_x) refuse("predictive_action.offset_state");
  if (now.offset_output.size() != s.n_y) refuse("predictive_action.offset_output");
  if (!sameSize(now.K, s.n_u, s.n_x)) refuse("predictive_action.K");
  if (now.feedforward.rows() != s.n_u || now.feedforward.cols() < s.n_c) {
    refuse("predictive_action.feedforward");
  }
  if (now.reference.rows() != s.n_y || now.reference.cols() < s.n_c) {
    refuse("predictive_action.reference");
  }
  if (now.setpoint.size() != s.n_y) refuse("predictive_action.setpoint");
  if (now.input_base_unclipped.size() != s.n_u) refuse("predictive_action.input_base_unclipped");
  if (now.input_previous.size() != s.n_u) refuse("predictive_action.input_previous");
}

bool isFinite(const PredictiveAction& now, Eigen::Index n_c) {
  return now.state.allFinite() && now.A.allFinite() && now.B.allFinite() && now.C.allFinite() &&
         now.offset_state.allFinite() && now.offset_output.allFinite() && now.K.allFinite() &&
         now.feedforward.leftCols(n_c).allFinite() && now.reference.leftCols(n_c).allFinite() &&
         now.setpoint.allFinite() && now.input_base_unclipped.allFinite() &&
         now.input_previous.allFinite();
}

Eigen::Index positive(Eigen::Index value, const char* name) {
  require(value >= 1, name, "a size >= 1");
  return value;
}

}  // namespace

struct ClosedLoopParadigm::Workspace {
  Workspace(ClpParams given, InputLimits input_limits, const ClpSizes& s)
      : params(std::move(given)),
        limits(std::move(input_limits)),
        sizes(s),
        prediction(s),
        cost(params, s),
        rows(params, limits, s),
        target(s.n_x, needsTarget(params) ? s.n_u : 0, params.target_outputs),
        terminal(s.n_x),
        solver(s.inputs() + rows.slacks(), rows.rows(), params.qp),
        Phi(s.n_x, s.n_x),
        Q(s.n_x, s.n_x),
        KRK(s.n_x, s.n_x),
        weighted_C(s.n_y, s.n_x),
        weighted_K(s.n_u, s.n_x),
        state(s.n_x),
        next_state(s.n_x),
        output(s.n_y),
        input(s.n_u),
        input_before(s.n_u),
        law(s.n_u) {
    const Eigen::Index n = s.inputs();
    problem.state_from_input = Matrix::Zero(s.n_x * s.n_c, n);
    problem.state_free = Vector::Zero(s.n_x * s.n_c);
    problem.perturbation_from_input = Matrix::Identity(n, n);
    problem.perturbation_free = Vector::Zero(n);
    problem.qp = QpProblem(n + rows.slacks(), rows.rows());
    rows.prepare(problem);
    solution.x = Vector::Zero(n + rows.slacks());
    solution.y_x = Vector::Zero(n + rows.slacks());
    solution.y_a = Vector::Zero(rows.rows());
  }

  bool lq() const { return params.cost == ClpCostKind::kLq; }
  SolveStatus decide(const PredictiveAction& now, Vector& action);
  bool consistent(const PredictiveAction& now);
  bool findAim(const PredictiveAction& now);
  bool baseLawIsAllowed(const PredictiveAction& now);
  void assemble(const PredictiveAction& now);
  void takeSolution(Vector& action) const;
  void takeBase(const PredictiveAction& now, Vector& action) const;
  bool protectActuator(const PredictiveAction& now, bool solved, ControlAction& action);

  ClpParams params;
  InputLimits limits;
  ClpSizes sizes;
  ClpPrediction prediction;
  ClpCost cost;
  ClpLimits rows;
  SteadyTarget target;
  TerminalWeight terminal;
  QpSolver solver;
  ClpProblem problem;
  QpResult solution;
  Matrix Phi, Q, KRK, weighted_C, weighted_K;
  Vector state, next_state, output, input, input_before, law;
};

bool ClosedLoopParadigm::Workspace::consistent(const PredictiveAction& now) {
  constexpr double kTolerance = 1e-9;
  law = now.feedforward.col(0);
  law -= now.K.lazyProduct(now.state);
  for (Eigen::Index a = 0; a < sizes.n_u; ++a) {
    const double base = now.input_base_unclipped[a];
    if (!(std::abs(law[a] - base) <= kTolerance * std::max(1.0, std::abs(base)))) return false;
  }
  return true;
}

// The steady state of the present local model at the setpoint and, for lq, the terminal weight of
// its base law.
bool ClosedLoopParadigm::Workspace::findAim(const PredictiveAction& now) {
  if (needsTarget(params) && !target.solve(now)) return false;
  if (!lq()) return true;
  Phi = now.A;
  Phi -= now.B.lazyProduct(now.K);
  weighted_C = params.weight_state_output.asDiagonal() * now.C;
  weighted_K = params.weight_input.asDiagonal() * now.K;
  Q.noalias() = now.C.transpose().lazyProduct(weighted_C);
  KRK.noalias() = now.K.transpose().lazyProduct(weighted_K);
  return terminal.compute(Phi, Q, KRK);
}

// Rolls the base law out over the horizon; leaves its inputs in solution.x.
bool ClosedLoopParadigm::Workspace::baseLawIsAllowed(const PredictiveAction& now) {
  state = now.state;
  input = now.input_base_unclipped;
  if (!rows.admitsFirst(input)) return false;
  const Eigen::Index n_c = sizes.n_c;
  for (Eigen::Index i = 0; i < n_c; ++i) {
    if (i > 0) {
      input_before.swap(input);
      input = now.feedforward.col(i);
      input -= now.K.lazyProduct(state);
      if (!rows.admitsNext(input, input_before)) return false;
    }
    solution.x.segment(i * sizes.n_u, sizes.n_u) = input.cwiseQuotient(problem.input_scale);
    next_state = now.offset_state;
    next_state += now.A.lazyProduct(state);
    next_state += now.B.lazyProduct(input);
    state.swap(next_state);
    output = now.offset_output;
    output += now.C.lazyProduct(state);
    if (!rows.admitsOutput(output)) return false;
  }
  return true;
}

void ClosedLoopParadigm::Workspace::assemble(const PredictiveAction& now) {
  prediction.law_offset = now.feedforward.leftCols(sizes.n_c);
  if (lq()) {
    law = target.input();
    law += now.K.lazyProduct(target.state());
    prediction.law_offset.colwise() = law;
  }
  prediction.compute(now);
  prediction.stack(problem);
  const ClpAim aim{target.state(), target.input(), terminal.weight()};
  cost.fill(now, prediction, lq() ? &aim : nullptr, problem);
  rows.fill(now, prediction, problem);
}

// Eq. 26: u = u_ss + u_opt, which is U(0) itself.
void ClosedLoopParadigm::Workspace::takeSolution(Vector& action) const {
  action = solution.x.head(sizes.n_u).cwiseProduct(problem.input_scale);
}

SolveStatus ClosedLoopParadigm::Workspace::decide(const PredictiveAction& now, Vector& action) {
  if (!isFinite(now, sizes.n_c)) return SolveStatus::kInvalidProblem;
  if (!consistent(now)) return SolveStatus::kInconsistent;
  if (!findAim(now)) return SolveStatus::kNumericalError;
  rows.set(now, target.input());
  assemble(now);
  if (!lq() && !cost.tracks() && baseLawIsAllowed(now)) {
    solution.status = SolveStatus::kSolved;
    solution.x.tail(rows.slacks()).setZero();
    solution.y_x.setZero();
    solution.y_a.setZero();
    action = now.input_base_unclipped;
    return solution.status;
  }
  solution = solver.solve(problem.qp);
  if (!solution.usable()) return solution.status;
  takeSolution(action);
  if (!action.allFinite()) return SolveStatus::kNumericalError;
  return rows.boundWins() ? SolveStatus::kBoundWins : SolveStatus::kSolved;
}

// The base law, or what comes nearest to it: the input that acts already, else zero.
void ClosedLoopParadigm::Workspace::takeBase(const PredictiveAction& now, Vector& action) const {
  action = now.input_base_unclipped;
  for (Eigen::Index a = 0; a < sizes.n_u; ++a) {
    if (!std::isfinite(action[a])) action[a] = now.input_previous[a];
    if (!std::isfinite(action[a])) action[a] = 0.0;
  }
}

// Absolute limits hold whatever was decided. True if the move limit had to give way to a bound.
bool ClosedLoopParadigm::Workspace::protectActuator(const PredictiveAction& now, bool solved,
                                                    ControlAction& action) {
  static constexpr double kNegligible = 1e-6;  // of the input's unit: no actuator shows less
  input = action.input;
  for (Eigen::Index a = 0; a < now.input_lower.size(); ++a)
    action.input[a] = std::clamp(action.input[a], now.input_lower[a], now.input_upper[a]);
  const bool move_gave_way = limits.clip(action.input, now.input_previous);
  const auto differs = [this](const Vector& left, const Vector& right) {
    return ((left - right).array().abs() > kNegligible * problem.input_scale.array()).any();
  };
  if (!now.input_base_unclipped.allFinite()) {
    action.source = ActionSource::kHeld;
  } else if (differs(action.input, input)) {
    action.source = ActionSource::kClipped;
  } else if (solved && differs(action.input, now.input_base_unclipped)) {
    action.source = ActionSource::kConstrained;
  } else {
    action.source = ActionSource::kBase;
  }
  return move_gave_way;
}

ClosedLoopParadigm::ClosedLoopParadigm(ClpParams params, InputLimits limits, Eigen::Index n_x,
                                       Eigen::Index n_y, Eigen::Index n_u) {
  limits.validate(positive(n_u, "n_u"));
  ClpParams filled = filledIn(std::move(params), positive(n_y, "n_y"), n_u);
  const ClpSizes sizes{positive(n_x, "n_x"), n_y, n_u, filled.perturbation_steps};
  work_ = std::make_unique<Workspace>(std::move(filled), std::move(limits), sizes);
}

ClosedLoopParadigm::~ClosedLoopParadigm() = default;
ClosedLoopParadigm::ClosedLoopParadigm(ClosedLoopParadigm&&) noexcept = default;

void ClosedLoopParadigm::reset() { work_->solver.forget(); }

void ClosedLoopParadigm::step(const PredictiveAction& now, ControlAction& action,
                              SolverReport& report) {
  const auto start = std::chrono::steady_clock::now();
  Workspace& work = *work_;
  checkSizes(now, work.sizes);
  work.solution.iterations = work.solution.active = 0;
  work.solution.kkt_residual = 0.0;
  action.header = report.header = now.header;
  report.status = work.decide(now, action.input);
  const bool solved =
      report.status == SolveStatus::kSolved || report.status == SolveStatus::kBoundWins;
  if (!solved) work.takeBase(now, action.input);
  const bool move_gave_way = work.protectActuator(now, solved, action);
  if (solved && work.rows.incremental() && move_gave_way) report.status = SolveStatus::kBoundWins;
  report.perturbation = action.input - now.input_base_unclipped;
  for (double& c : report.perturbation) c = std::isfinite(c) ? c : 0.0;
  report.iterations = static_cast<std::uint32_t>(std::max(work.solution.iterations, 0));
  report.active_rows = solved ? static_cast<std::uint32_t>(work.solution.active) : 0;
  report.kkt_residual = work.solution.kkt_residual;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  report.seconds = elapsed.count();
}

const ClpProblem& ClosedLoopParadigm::problem() const { return work_->problem; }
const QpResult& ClosedLoopParadigm::solution() const { return work_->solution; }
const Vector& ClosedLoopParadigm::steadyState() const { return work_->target.state(); }
const Vector& ClosedLoopParadigm::steadyInput() const { return work_->target.input(); }

}  // namespace fpc
