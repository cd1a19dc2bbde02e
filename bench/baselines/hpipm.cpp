// HPIPM: an interior-point method on BLASFEO's kernels; its dense form.
#include <blasfeo_d_aux.h>
#include <hpipm_d_dense_qp.h>
#include <hpipm_d_dense_qp_dim.h>
#include <hpipm_d_dense_qp_ipm.h>
#include <hpipm_d_dense_qp_sol.h>

#include <cmath>
#include <numeric>

#include "baselines/baseline_qp.hpp"
#include "baselines/split_qp.hpp"

namespace fpc::bench {
namespace {

/// Memory for one of HPIPM's structs.
struct Room {
  std::vector<char> bytes;
  void* of(std::size_t size) {
    bytes.assign(size + 64, 0);
    return bytes.data();
  }
};

/// A finite limit, and 1 where there is one, else 0.
struct Limit {
  Vector value, mask;
  explicit Limit(const Vector& v)
      : value(v.unaryExpr([](double one) { return std::isfinite(one) ? one : 0.0; })),
        mask(v.unaryExpr([](double one) { return std::isfinite(one) ? 1.0 : 0.0; })) {}
};

class Hpipm final : public BaselineQp {
 public:
  void prepare(const QpProblem& p) override {
    SplitQp split(p);
    H_ = p.H;
    std::vector<int> bounded;
    for (Eigen::Index i = 0; i < p.g.size(); ++i)
      if (std::isfinite(split.x_lower(i)) || std::isfinite(split.x_upper(i)))
        bounded.push_back(static_cast<int>(i));
    d_dense_qp_dim_create(&dim_, rooms_[0].of(d_dense_qp_dim_memsize()));
    d_dense_qp_dim_set_all(static_cast<int>(p.g.size()), static_cast<int>(split.e.size()),
                           static_cast<int>(bounded.size()), static_cast<int>(split.lower.size()),
                           0, &dim_);
    d_dense_qp_create(&dim_, &qp_, rooms_[1].of(d_dense_qp_memsize(&dim_)));
    set(p, split, bounded);
    d_dense_qp_sol_create(&dim_, &solution_, rooms_[2].of(d_dense_qp_sol_memsize(&dim_)));
    d_dense_qp_ipm_arg_create(&dim_, &arg_, rooms_[3].of(d_dense_qp_ipm_arg_memsize(&dim_)));
    d_dense_qp_ipm_arg_set_default(SPEED, &arg_);
    int steps = kSteps;
    d_dense_qp_ipm_arg_set_iter_max(&steps, &arg_);
    d_dense_qp_ipm_ws_create(&dim_, &arg_, &work_,
                             rooms_[4].of(d_dense_qp_ipm_ws_memsize(&dim_, &arg_)));
  }

  bool solve() override { return solveFrom(0, true); }
  bool solveWarm(bool new_hessian) override { return solveFrom(2, new_hessian); }
  bool canWarm() const override { return true; }
  Vector x() const override {
    Vector x(H_.rows());
    d_dense_qp_sol_get_v(const_cast<d_dense_qp_sol*>(&solution_), x.data());
    return x;
  }

 private:
  static constexpr int kSteps = 100;  // the mode's own 15 are too few

  void set(const QpProblem& p, SplitQp& split, std::vector<int>& bounded) {
    Limit x_lower(split.x_lower(bounded)), x_upper(split.x_upper(bounded));
    Limit lower(split.lower), upper(split.upper);
    Vector g = p.g;
    d_dense_qp_set_H(H_.data(), &qp_);
    d_dense_qp_set_g(g.data(), &qp_);
    d_dense_qp_set_A(split.E.data(), &qp_);
    d_dense_qp_set_b(split.e.data(), &qp_);
    d_dense_qp_set_idxb(bounded.data(), &qp_);
    d_dense_qp_set_lb(x_lower.value.data(), &qp_);
    d_dense_qp_set_ub(x_upper.value.data(), &qp_);
    d_dense_qp_set_lb_mask(x_lower.mask.data(), &qp_);
    d_dense_qp_set_ub_mask(x_upper.mask.data(), &qp_);
    d_dense_qp_set_C(split.G.data(), &qp_);
    d_dense_qp_set_lg(lower.value.data(), &qp_);
    d_dense_qp_set_ug(upper.value.data(), &qp_);
    d_dense_qp_set_lg_mask(lower.mask.data(), &qp_);
    d_dense_qp_set_ug_mask(upper.mask.data(), &qp_);
  }

  /// @param known 0 nothing, 2 point and multipliers of the solve before
  bool solveFrom(int known, bool new_hessian) {
    if (new_hessian) d_dense_qp_set_H(H_.data(), &qp_);
    d_dense_qp_ipm_arg_set_warm_start(&known, &arg_);
    d_dense_qp_ipm_solve(&qp_, &solution_, &arg_, &work_);
    int status = 0;
    d_dense_qp_ipm_get_status(&work_, &status);
    return status == SUCCESS;
  }

  Matrix H_;
  Room rooms_[5];
  d_dense_qp_dim dim_{};
  d_dense_qp qp_{};
  d_dense_qp_sol solution_{};
  d_dense_qp_ipm_arg arg_{};
  d_dense_qp_ipm_ws work_{};
};

const bool kRegistered = registerBaseline(
    "HPIPM", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Hpipm>(); });

}  // namespace
}  // namespace fpc::bench
