// PIQP: a proximal interior-point method on Eigen; its dense solver, by its C interface.
#include <piqp.h>

#include <cmath>

#include "baselines/baseline_qp.hpp"
#include "baselines/split_qp.hpp"

namespace fpc::bench {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Piqp final : public BaselineQp {
 public:
  ~Piqp() override { release(); }

  void prepare(const QpProblem& p) override {
    release();
    SplitQp split(p);
    H_ = p.H;
    RowMajor E = split.E, G = split.G;
    Vector g = p.g, lower = bounded(split.lower), upper = bounded(split.upper);
    Vector x_lower = bounded(split.x_lower), x_upper = bounded(split.x_upper);
    piqp_data_dense data{};
    data.n = static_cast<piqp_int>(g.size());
    data.p = static_cast<piqp_int>(E.rows());
    data.m = static_cast<piqp_int>(G.rows());
    data.P = H_.data();
    data.c = g.data();
    data.A = E.data();
    data.b = split.e.data();
    data.G = G.data();
    data.h_l = lower.data();
    data.h_u = upper.data();
    data.x_l = x_lower.data();
    data.x_u = x_upper.data();
    piqp_settings settings{};
    piqp_set_default_settings_dense(&settings);
    piqp_setup_dense(&work_, &data, &settings);
  }

  bool solve() override {
    piqp_update_dense(work_, H_.data(), nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
                      nullptr, nullptr);
    return piqp_solve(work_) == PIQP_SOLVED;
  }
  Vector x() const override {
    return Eigen::Map<const Vector>(work_->result->x, work_->solver_info.n);
  }

 private:
  static Vector bounded(const Vector& v) { return v.cwiseMax(-PIQP_INF).cwiseMin(PIQP_INF); }

  void release() {
    if (work_ != nullptr) piqp_cleanup(work_);
    work_ = nullptr;
  }

  RowMajor H_;
  piqp_workspace* work_{};
};

const bool kRegistered = registerBaseline(
    "PIQP", []() -> std::unique_ptr<BaselineQp> { return std::make_unique<Piqp>(); });

}  // namespace
}  // namespace fpc::bench
