#include "identification/joint_run.hpp"

#include <algorithm>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthestJoint = 30.0;  // deviations: where a run is held that runs away

/// A row of the exogenous values that is another output.
struct Partner {
  Index row, output, lag;
};

class Member {
 public:
  Member(const JointMember& member, Index output)
      : fitted_(*member.fitted),
        record_(*member.record),
        output_(output),
        step_(fitted_.shape),
        x_(fitted_.shape.states),
        next_(fitted_.shape.states),
        v_(record_.v.rows()) {
    for (std::size_t r = 0; r < fitted_.exogenous.size(); ++r) {
      const Regressor& e = fitted_.exogenous[r];
      if (e.kind == SignalKind::kOutput)
        partners_.push_back({static_cast<Index>(r), Index{e.index}, Index{e.lag}});
    }
  }

  /// Rows of the past that a step needs.
  Index past() const {
    Index rows = fitted_.shape.states;
    for (const auto& p : partners_) rows = std::max(rows, p.lag + 1);
    return rows;
  }

  /// State after row k; NaN where something is not known.
  double next(const Matrix& past, Index k) {
    for (Index j = 0; j < x_.size(); ++j) x_[j] = past(k - j, output_);
    v_ = record_.v.col(k);
    for (const auto& p : partners_) v_[p.row] = past(k - p.lag, p.output);
    if (!x_.allFinite() || !v_.allFinite()) return kNaN;
    step_.predict(fitted_.parameters, x_, v_, next_);
    return std::clamp(next_[0], -kFarthestJoint, kFarthestJoint);
  }
  double output(double state) const { return fitted_.shape.output(state); }

 private:
  const Fitted& fitted_;
  const RecurrentData& record_;
  Index output_;
  RecurrentStep step_;
  Vector x_, next_, v_;
  std::vector<Partner> partners_;
};

}  // namespace

Matrix jointFreeRun(const std::vector<JointMember>& given, const Matrix& measured,
                    Stretch stretch) {
  const auto n_y = static_cast<Index>(given.size());
  std::vector<Member> members;
  Index longest = 1;
  for (Index i = 0; i < n_y; ++i) {
    members.emplace_back(given[static_cast<std::size_t>(i)], i);
    longest = std::max(longest, members.back().past());
  }
  Matrix past = measured, said = Matrix::Constant(measured.rows(), n_y, kNaN);
  Vector next(n_y);
  Index first = stretch.first;
  for (Index k = stretch.first; k + 1 < stretch.last; ++k) {
    if (k - first + 1 < longest) continue;
    for (Index i = 0; i < n_y; ++i) next[i] = members[static_cast<std::size_t>(i)].next(past, k);
    if (!next.allFinite()) {
      first = k + 1;
      continue;
    }
    past.row(k + 1) = next.transpose();
    for (Index i = 0; i < n_y; ++i)
      said(k + 1, i) = members[static_cast<std::size_t>(i)].output(next[i]);
  }
  return said;
}

}  // namespace fpc
