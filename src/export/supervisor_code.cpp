// Controller type load_supervisor as code of a block: see LoadSupervisor.
#include "control/supervisor/load_supervisor.hpp"
#include "export/block.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Value;

class SupervisorCode final : public LawCode {
 public:
  SupervisorCode(BlockParts& parts, const LoadSupervisorParams& params)
      : b_(parts), p_(parts.p), params_(params) {
    hours_ = parts.loop.plant_info.sample_time_s / 3600.0;
    integral_ = p_.state("share", Kind::kReal);
    transfer_ = p_.state("transfer", Kind::kBool);
    error_ = p_.work("error");
    direct_ = p_.work("direct");
    unclipped_ = p_.work("unclipped");
    size_ = p_.work("size");
    handed_ = p_.work("handed", Kind::kBool);
    integral_out_ = p_.output("rIntegral", Kind::kReal, "integral's share of the output");
  }

  void reset() override {
    p_.set(integral_, 0.0);
    p_.set(transfer_, true);
  }

  void step() override {
    const Value u = b_.u[params_.input], applied = b_.applied[params_.input];
    const double limit = std::min(params_.integral_limit, ir::kLargest);
    p_.loop(b_.n_u, [&](const Value& i) { p_.set(b_.u[i], b_.applied[i]); });
    p_.set(error_, b_.y[params_.output] - b_.setpoint[params_.output]);
    p_.set(direct_,
           params_.kp * error_ +
               params_.load_gain *
                   (b_.d[params_.concentration] * b_.d[params_.flow] / params_.nominal_load - 1.0));
    p_.when(transfer_ && ir::sane(direct_), [&] {
      p_.set(integral_, applied - direct_);
      p_.clamp(integral_, -limit, limit);
    });
    p_.set(unclipped_, direct_ + integral_);
    p_.when(
        ir::sane(unclipped_), [&] { answer(u, limit); },
        [&] {
          p_.set(b_.ok, false);
          p_.set(b_.source, static_cast<int>(ActionSource::kHeld));
        });
  }

  void signals() override { p_.set(integral_out_, integral_); }

 private:
  void answer(const Value& u, double limit) {
    p_.setAbsolute(size_, integral_);
    p_.set(handed_, transfer_ && size_ < limit);
    p_.set(transfer_, false);
    p_.when(!handed_, [&] { p_.set(u, unclipped_); });
    clipInputs(b_, b_.u, b_.applied);
    p_.when(u != unclipped_ && !handed_,
            [&] { p_.set(b_.source, static_cast<int>(ActionSource::kClipped)); });
    p_.set(integral_, integral_ + hours_ * (params_.ki_per_h * error_ +
                                            (u - unclipped_) / params_.tracking_time_h));
    p_.clamp(integral_, -limit, limit);
  }

  BlockParts& b_;
  ir::Program& p_;
  const LoadSupervisorParams& params_;
  double hours_{};
  Value integral_{0}, transfer_{0}, error_{0}, direct_{0}, unclipped_{0}, size_{0}, handed_{0},
      integral_out_{0};
};

}  // namespace

std::unique_ptr<LawCode> makeSupervisorCode(BlockParts& parts) {
  const auto* params = findParams<LoadSupervisorParams>(*parts.loop.controller);
  return params ? std::make_unique<SupervisorCode>(parts, *params) : nullptr;
}

}  // namespace fpc
