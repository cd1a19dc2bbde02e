// OSQP: an operator-splitting method on sparse data. The step length that a solve has adapted is
// kept for the next one, in its favour.
#include <osqp.h>

#include <cmath>

#include "baselines/baseline_qp.hpp"

namespace fpc::bench {
namespace {

/// Compressed columns that OSQP reads from here.
struct Columns {
  std::vector<OSQPInt> starts, rows;
  std::vector<OSQPFloat> values;
  OSQPCscMatrix view{};

  void take(const Matrix& M, bool upper_only) {
    starts.assign(1, 0);
    rows.clear();
    values.clear();
    for (Eigen::Index j = 0; j < M.cols(); ++j) {
      for (Eigen::Index i = 0; i < (upper_only ? j + 1 : M.rows()); ++i) {
        if (M(i, j) == 0.0) continue;
        rows.push_back(i);
        values.push_back(M(i, j));
      }
      starts.push_back(static_cast<OSQPInt>(rows.size()));
    }
    OSQPCscMatrix_set_data(&view, M.rows(), M.cols(), static_cast<OSQPInt>(rows.size()),
                           values.data(), rows.data(), starts.data());
  }
};

class Osqp final : public BaselineQp {
 public:
  ~Osqp() override { release(); }

  void prepare(const QpProblem& p) override {
    release();
    const Eigen::Index n = p.g.size(), m = p.a_lower.size();
    Vector lower(n + m), upper(n + m);
    lower << p.x_lower, p.a_lower;
    upper << p.x_upper, p.a_upper;
    Matrix all(n + m, n);
    all << Matrix::Identity(n, n), p.A;
    std::vector<Eigen::Index> limited;
    for (Eigen::Index i = 0; i < n + m; ++i)
      if (std::isfinite(lower(i)) || std::isfinite(upper(i))) limited.push_back(i);
    P_.take(p.H, true);
    A_.take(all(limited, Eigen::all), false);
    g_ = p.g;
    lower_ = lower(limited).cwiseMax(-OSQP_INFTY);
    upper_ = upper(limited).cwiseMin(OSQP_INFTY);
    OSQPSettings settings;
    osqp_set_default_settings(&settings);
    settings.verbose = 0;
    settings.eps_abs = settings.eps_rel = 1e-9;
    settings.max_iter = 100000;
    osqp_setup(&solver_, &P_.view, g_.data(), &A_.view, lower_.data(), upper_.data(), lower_.size(),
               n, &settings);
  }

  bool solve() override { return solveFrom(true, true); }
  bool solveWarm(bool new_hessian) override { return solveFrom(false, new_hessian); }
  bool canWarm() const override { return true; }
  Vector x() const override {
    return solver_ == nullptr ? Vector()
                              : Eigen::Map<const Vector>(solver_->solution->x, g_.size());
  }

 private:
  bool solveFrom(bool nothing, bool new_hessian) {
    if (solver_ == nullptr) return false;
    if (new_hessian)
      osqp_update_data_mat(solver_, P_.values.data(), nullptr,
                           static_cast<OSQPInt>(P_.values.size()), nullptr, nullptr, 0);
    if (nothing) osqp_cold_start(solver_);
    osqp_solve(solver_);
    return solver_->info->status_val == OSQP_SOLVED;
  }

  void release() {
    if (solver_ != nullptr) osqp_cleanup(solver_);
    solver_ = nullptr;
  }

  Columns P_, A_;
  Vector g_, lower_, upper_;
  OSQPSolver* solver_{};
};

const bool kRegistered = registerBaseline(
    "OSQP", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Osqp>(); });

}  // namespace
}  // namespace fpc::bench
