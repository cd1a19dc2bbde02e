// eiquadprog: Goldfarb and Idnani's method on Eigen, the "fast" variant.
#include <eiquadprog/eiquadprog-fast.hpp>

#include <cmath>

#include "baselines/baseline_qp.hpp"

namespace fpc::bench {
namespace {

class Eiquadprog final : public BaselineQp {
 public:
  void prepare(const QpProblem& p) override {
    H_ = p.H;
    g_ = p.g;
    equal_rows_.clear();
    rows_.clear();
    const Matrix I = Matrix::Identity(p.g.size(), p.g.size());
    for (Eigen::Index i = 0; i < p.g.size(); ++i) add(I.row(i), p.x_lower(i), p.x_upper(i));
    for (Eigen::Index i = 0; i < p.a_lower.size(); ++i) add(p.A.row(i), p.a_lower(i), p.a_upper(i));
    fill(equal_rows_, p.g.size(), E_, e_);
    fill(rows_, p.g.size(), G_, h_);
    x_.setZero(p.g.size());
    solver_.reset(static_cast<std::size_t>(p.g.size()), equal_rows_.size(), rows_.size());
    solver_.setMaxIter(10000);
  }

  bool solve() override {
    return solver_.solve_quadprog(H_, g_, E_, e_, G_, h_, x_) ==
           eiquadprog::solvers::EIQUADPROG_FAST_OPTIMAL;
  }
  Vector x() const override { return x_; }

 private:
  struct Row {
    Vector normal;
    double offset;  // normal'x + offset >= 0, or = 0
  };

  void add(const Vector& normal, double lower, double upper) {
    if (lower == upper) {
      equal_rows_.push_back({normal, -lower});
      return;
    }
    if (std::isfinite(lower)) rows_.push_back({normal, -lower});
    if (std::isfinite(upper)) rows_.push_back({-normal, upper});
  }

  static void fill(const std::vector<Row>& rows, Eigen::Index n, Matrix& M, Vector& v) {
    M.resize(static_cast<Eigen::Index>(rows.size()), n);
    v.resize(M.rows());
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      M.row(i) = rows[static_cast<std::size_t>(i)].normal.transpose();
      v(i) = rows[static_cast<std::size_t>(i)].offset;
    }
  }

  Matrix H_, E_, G_;
  Vector g_, e_, h_, x_;
  std::vector<Row> equal_rows_, rows_;
  eiquadprog::solvers::EiquadprogFast solver_;
};

const bool kRegistered = registerBaseline(
    "eiquadprog", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Eiquadprog>(); });

}  // namespace
}  // namespace fpc::bench
