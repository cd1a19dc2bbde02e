// qpOASES (ferreau2014): an online active-set method.
#include <qpOASES.hpp>

#include <cmath>

#include "baselines/baseline_qp.hpp"

namespace fpc::bench {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class QpOases final : public BaselineQp {
 public:
  void prepare(const QpProblem& p) override {
    H_ = p.H;
    A_ = p.A;
    g_ = p.g;
    x_lower_ = bounded(p.x_lower);
    x_upper_ = bounded(p.x_upper);
    a_lower_ = bounded(p.a_lower);
    a_upper_ = bounded(p.a_upper);
    x_.setZero(p.g.size());
    solver_ = std::make_unique<qpOASES::SQProblem>(static_cast<int>(p.g.size()),
                                                   static_cast<int>(p.a_lower.size()));
    qpOASES::Options options;
    options.setToMPC();
    options.printLevel = qpOASES::PL_NONE;
    solver_->setOptions(options);
    solved_ = false;
  }

  bool solve() override {
    if (solved_) solver_->reset();
    int steps = kSteps;
    const auto status = solver_->init(H_.data(), g_.data(), A_.data(), x_lower_.data(),
                                      x_upper_.data(), a_lower_.data(), a_upper_.data(), steps);
    return finish(status);
  }
  bool solveWarm(bool /*new_hessian*/) override {
    if (!solved_) return solve();
    int steps = kSteps;
    return finish(solver_->hotstart(H_.data(), g_.data(), A_.data(), x_lower_.data(),
                                    x_upper_.data(), a_lower_.data(), a_upper_.data(), steps));
  }
  bool canWarm() const override { return true; }
  Vector x() const override { return x_; }

 private:
  static constexpr int kSteps = 10000;

  static Vector bounded(const Vector& v) {
    return v.cwiseMax(-qpOASES::INFTY).cwiseMin(qpOASES::INFTY);
  }

  bool finish(qpOASES::returnValue status) {
    solved_ = true;
    solver_->getPrimalSolution(x_.data());
    return status == qpOASES::SUCCESSFUL_RETURN;
  }

  RowMajor H_, A_;
  Vector g_, x_lower_, x_upper_, a_lower_, a_upper_, x_;
  std::unique_ptr<qpOASES::SQProblem> solver_;
  bool solved_{};
};

const bool kRegistered = registerBaseline(
    "qpOASES", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<QpOases>(); });

}  // namespace
}  // namespace fpc::bench
