// DAQP (arnstrom2022): a dual active-set method, in C.
#include <api.h>
#include <utils.h>

#include <cmath>

#include "baselines/baseline_qp.hpp"

namespace fpc::bench {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kVectors = DAQP_UPDATE_v | DAQP_UPDATE_d;
constexpr int kEverything = DAQP_UPDATE_Rinv | DAQP_UPDATE_M | kVectors;
constexpr int kFreeFirst =
    DAQP_UPDATE_unconstrained;  // the minimum without limits, as its quadprog

class Daqp final : public BaselineQp {
 public:
  ~Daqp() override { release(); }

  void prepare(const QpProblem& p) override {
    release();
    H_ = p.H;
    A_ = p.A;
    g_ = p.g;
    lower_.resize(p.x_lower.size() + p.a_lower.size());
    upper_.resize(lower_.size());
    lower_ << p.x_lower, p.a_lower;
    upper_ << p.x_upper, p.a_upper;
    lower_ = lower_.cwiseMax(-DAQP_INF);
    upper_ = upper_.cwiseMin(DAQP_INF);
    x_.setZero(p.g.size());
    multipliers_.setZero(lower_.size());
    sense_.assign(static_cast<std::size_t>(lower_.size()), 0);
    for (Eigen::Index i = 0; i < lower_.size(); ++i)
      if (lower_(i) == upper_(i))
        sense_[static_cast<std::size_t>(i)] = DAQP_ACTIVE | DAQP_IMMUTABLE;
    data_ = {};
    data_.n = static_cast<int>(p.g.size());
    data_.m = static_cast<int>(lower_.size());
    data_.ms = data_.n;
    data_.H = H_.data();
    data_.f = g_.data();
    data_.A = A_.data();
    data_.bupper = upper_.data();
    data_.blower = lower_.data();
    data_.sense = sense_.data();
    work_ = {};
    ready_ = setup_daqp(&data_, &work_, nullptr) >= 0;
    if (ready_) work_.settings->primal_tol = 1e-9;
    result_ = {};
    result_.x = x_.data();
    result_.lam = multipliers_.data();
  }

  bool solve() override {
    if (!ready_) return false;
    daqp_deactivate_constraints(&work_);
    reset_daqp_workspace(&work_);
    return update(kEverything | kFreeFirst | DAQP_UPDATE_sense);
  }
  bool solveWarm(bool new_hessian) override {
    if (!ready_) return false;
    if (new_hessian) return update(kEverything | kFreeFirst, true);
    return unformed_ ? update(kEverything, true) : update(kVectors);
  }
  bool canWarm() const override { return true; }
  Vector x() const override { return x_; }

 private:
  /// An update takes a new Hessian in but keeps the factor of the working set, that of the old one.
  bool update(int mask, bool factor_anew = false) {
    if (daqp_update_ldp(mask, &work_, &data_) < 0) return false;
    unformed_ = work_.sing_ind == DAQP_UNCONSTRAINED_OPTIMAL;
    if (factor_anew && !unformed_) {
      reset_daqp_workspace(&work_);
      if (daqp_activate_constraints(&work_) < 0) return false;
    }
    daqp_solve(&result_, &work_);
    return result_.exitflag > 0;
  }

  void release() {
    if (!ready_) return;
    free_daqp_workspace(&work_);
    free_daqp_ldp(&work_);
    ready_ = false;
  }

  RowMajor H_, A_;
  Vector g_, lower_, upper_, x_, multipliers_;
  std::vector<int> sense_;
  DAQPProblem data_{};
  DAQPWorkspace work_{};
  DAQPResult result_{};
  bool ready_{};
  bool unformed_{};  // the limits, because they were not needed
};

const bool kRegistered = registerBaseline(
    "DAQP", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Daqp>(); });

}  // namespace
}  // namespace fpc::bench
