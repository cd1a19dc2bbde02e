// dlib: coordinate descent, then Nesterov's gradient method, for bounds only.
#include <dlib/optimization/optimization_solve_qp_using_smo.h>

#include <cmath>

#include "baselines/baseline_qp.hpp"

namespace fpc::bench {
namespace {

using Column = dlib::matrix<double, 0, 1>;

class Dlib final : public BaselineQp {
 public:
  bool canTake(const QpProblem& p) const override {
    return p.a_lower.size() == 0 && p.x_lower.allFinite() && p.x_upper.allFinite();
  }

  void prepare(const QpProblem& p) override {
    H_.set_size(p.H.rows(), p.H.cols());
    for (long i = 0; i < H_.nr(); ++i)
      for (long j = 0; j < H_.nc(); ++j) H_(i, j) = p.H(i, j);
    g_ = column(p.g);
    lower_ = column(p.x_lower);
    upper_ = column(p.x_upper);
    x_ = lower_;
  }

  bool solve() override {
    x_ = dlib::clamp(dlib::zeros_matrix(x_), lower_, upper_);
    return solveWarm(true);
  }
  bool solveWarm(bool /*new_hessian*/) override {
    return dlib::solve_qp_box_constrained(H_, g_, x_, lower_, upper_, kTolerance, kSteps) <= kSteps;
  }
  bool canWarm() const override { return true; }
  Vector x() const override { return Eigen::Map<const Vector>(&x_(0), x_.size()); }

 private:
  static constexpr double kTolerance = 1e-10;
  static constexpr unsigned long kSteps = 1000000;

  static Column column(const Vector& v) {
    Column c(v.size());
    for (long i = 0; i < c.size(); ++i) c(i) = v(i);
    return c;
  }

  dlib::matrix<double> H_;
  Column g_, lower_, upper_, x_;
};

const bool kRegistered = registerBaseline(
    "dlib", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Dlib>(); });

}  // namespace
}  // namespace fpc::bench
