#include "estimation/model_observer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kLongestWalk = 1000;  // samples before a start

std::vector<Index> rowsOf(const LocalModel& local) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < local.model().outputs.size(); ++i)
    rows.push_back(local.outputState(static_cast<Index>(i)));
  return rows;
}

}  // namespace

ModelObserver::ModelObserver(LocalModel local, const ObserverParams& params, int delay)
    : local_(std::move(local)),
      filter_(params, local_.stateSize(), rowsOf(local_)),
      delayed_(Vector::Zero(local_.stateSize())),
      state_(delayed_),
      before_(delayed_),
      next_(delayed_),
      inputs_(Matrix::Zero(local_.affine().B.cols(), delay + 1)),
      disturbances_(
          Matrix::Zero(static_cast<Index>(local_.model().disturbances.size()), delay + 1)) {
  placeEstimated(params.estimated);
  if (!params.beginsMoving()) return;
  const TsModel& model = local_.model();
  const Index n_y = countOf(model.outputs);
  rest_.setZero(local_.stateSize(), n_y);
  most_.resize(n_y);
  for (Index i = 0; i < n_y; ++i) {
    const SignalInfo& y = model.outputs[static_cast<std::size_t>(i)];
    most_[i] = std::pow(y.upper - y.lower, 2) / 12.0;
    local_.restState(Vector::Unit(n_y, i), Vector::Zero(countOf(model.inputs)),
                     Vector::Zero(countOf(model.disturbances)), rest_.col(i));
  }
}

void ModelObserver::placeEstimated(const std::vector<EstimatedDisturbance>& estimated) {
  const std::vector<std::string> known = namesOf(local_.model().unmeasured);
  for (const EstimatedDisturbance& d : estimated) {
    const auto found = std::find(known.begin(), known.end(), d.name);
    require(found != known.end(), "controller.observer.estimated." + d.name,
            "an unmeasured disturbance of the model, which has " +
                (known.empty() ? "none" : join(known)));
    const auto place = static_cast<int>(found - known.begin());
    const int lags = local_.model().maxLag(SignalKind::kUnmeasured, place);
    const double walked = std::round(std::pow(d.std / d.walk_std, 2));
    hidden_.push_back({local_.unmeasuredState(place), std::max(lags, 0) + 1, d.std, d.walk_std,
                       static_cast<int>(std::min<double>(walked, kLongestWalk))});
  }
}

void ModelObserver::rest(VectorRef outputs, VectorRef input, VectorRef disturbances, bool in_run) {
  const bool known = in_run && begun_;
  local_.restState(outputs, input, disturbances, delayed_);
  for (const Hidden& d : hidden_)
    if (known) delayed_.segment(d.row, d.rows).setConstant(state_[d.row]);
  local_.blend(delayed_, input, disturbances);
  const AffineModel& m = local_.affine();
  next_ = delayed_ - m.g;
  next_ -= m.A.lazyProduct(delayed_);
  next_ -= m.B.lazyProduct(Vector::Map(input.data(), input.size()));
  filter_.reset();
  filter_.startFrom(next_);
  state_ = before_ = delayed_;
  inputs_.colwise() = Vector::Map(input.data(), input.size());
  disturbances_.colwise() = Vector::Map(disturbances.data(), disturbances.size());
  before_start_ = known ? -1 : inputs_.cols() - 1;
  begun_ = true;
  if (known) loosen(&Hidden::walk_std, kUnknownChanges);
  if (!known && rest_.size() > 0) walkToStart();
}

/// The covariance at the start of a process that rested, then moved with its disturbances. A walk
/// ends where an output may be anywhere in its range: an unstable process has not gone on so long.
void ModelObserver::walkToStart() {
  before_start_ = -1;
  filter_.beCertain();
  int left = 0;
  for (const Hidden& d : hidden_) left = std::max(left, d.walked);
  const auto isWithin = [&] {
    for (Index i = 0; i < most_.size(); ++i)
      if (filter_.variance(local_.outputState(i)) > most_[i]) return false;
    return true;
  };
  for (; left > 0 && isWithin(); --left) {
    filter_.predict(local_.affine().A);
    for (const Hidden& d : hidden_)
      if (left <= d.walked) filter_.loosen(d.row, d.walk_std);
  }
  filter_.readAfterRest(rest_, local_.affine().A);
}

void ModelObserver::inherit(const ModelObserver& other) {
  delayed_ = other.delayed_;
  state_ = other.state_;
  before_ = other.before_;
  inputs_ = other.inputs_;
  disturbances_ = other.disturbances_;
  filter_ = other.filter_;
  before_start_ = other.before_start_;
  begun_ = other.begun_;
}

void ModelObserver::loosen(double Hidden::*std, double times) {
  for (const Hidden& d : hidden_) filter_.loosen(d.row, times * d.*std);
}

/// One sample on, with the disturbance; the matrices of the blend stay in local_.
void ModelObserver::move(VectorRef input, VectorRef disturbances, Vector& state) {
  local_.advance(state, input, disturbances, next_);
  filter_.addDisturbance(next_);
  state.swap(next_);
}

void ModelObserver::foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) {
  if (inputs_.cols() > 1)
    local_.advance(delayed_, inputs_.col(1), disturbances_.col(1), next_);
  else
    local_.advance(delayed_, input, disturbances, next_);
  filter_.addDisturbance(next_);
  for (Index i = 0; i < outputs.size(); ++i) outputs[i] = next_[local_.outputState(i)];
}

void ModelObserver::advance(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  const Index last = inputs_.cols() - 1;
  for (Index j = 0; j < last; ++j) {
    inputs_.col(j) = inputs_.col(j + 1);
    disturbances_.col(j) = disturbances_.col(j + 1);
  }
  inputs_.col(last) = input;
  disturbances_.col(last) = disturbances;
  before_ = delayed_;
  move(inputs_.col(0), disturbances_.col(0), delayed_);
  if (before_start_ == 0) loosen(&Hidden::std);
  filter_.predict(local_.affine().A);
  if (before_start_ <= 0) loosen(&Hidden::walk_std);
  before_start_ = std::max<Index>(before_start_ - 1, -1);
  filter_.correct(outputs, delayed_);
  state_ = delayed_;
  for (Index j = 1; j <= last; ++j) move(inputs_.col(j), disturbances_.col(j), state_);
}

}  // namespace fpc
