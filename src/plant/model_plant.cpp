// Source of the two equations of noiseOf(): y = C xi + v, xi(k+1) = A xi(k) + b e(k).
#include "plant/model_plant.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kNoRange = 1e6;        // of a signal whose data nobody knows
constexpr int kResponseSamples = 2000;  // of a load
constexpr double kDiedOut = 1e-12;      // square of a response to 1
constexpr int kRestSteps = 50;          // of Newton's method
constexpr double kSameSampleTime = 1e-3;
constexpr double kParts[] = {0.5, 0.35, 0.65, 0.2, 0.8, 0.05, 0.95};  // of the inputs' ranges

bool isKnown(const SignalInfo& s) { return std::isfinite(s.lower) && std::isfinite(s.upper); }
double widthOf(const SignalInfo& s) { return isKnown(s) ? s.upper - s.lower : kNoRange; }
double partOf(const SignalInfo& s, double part) {
  return isKnown(s) ? s.lower + part * (s.upper - s.lower) : 0.0;
}
Vector partsOf(const std::vector<SignalInfo>& signals, double part) {
  Vector values(static_cast<Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i)
    values[static_cast<Index>(i)] = partOf(signals[i], part);
  return values;
}

/// What one sample adds to outputs that have rested at y.
Vector changeAtRest(LocalModel& local, VectorRef y, VectorRef u, VectorRef d) {
  Vector rest(local.stateSize()), next;
  local.restState(y, u, d, rest);
  local.advance(rest, u, d, next);
  return local.affine().C * next - y;
}

/// Newton's method; false if it does not come to rest.
bool findRest(LocalModel& local, VectorRef u, VectorRef d, VectorRef size, Vector& y) {
  for (int step = 0; step < kRestSteps; ++step) {
    const Vector change = changeAtRest(local, y, u, d);
    if (!change.allFinite()) return false;
    if ((change.array().abs() <= 1e-12 * size.array()).all()) return true;
    Matrix slope(y.size(), y.size());
    for (Index j = 0; j < y.size(); ++j) {
      Vector beside = y;
      beside[j] += 1e-6 * size[j];
      slope.col(j) = (changeAtRest(local, beside, u, d) - change) / (1e-6 * size[j]);
    }
    const Eigen::FullPivLU<Matrix> lu(slope);
    if (!lu.isInvertible()) return false;
    y -= lu.solve(change).cwiseMax(-size).cwiseMin(size);
  }
  return false;
}

bool isInside(VectorRef y, const std::vector<SignalInfo>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (!(y[static_cast<Index>(i)] >= outputs[i].lower &&
          y[static_cast<Index>(i)] <= outputs[i].upper))
      return false;
  return true;
}

struct NominalPoint {
  Vector y, u, d;
};

Vector sizesOf(const TsModel& model) {
  Vector size(static_cast<Index>(model.outputs.size()));
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    size[static_cast<Index>(i)] = std::max(widthOf(model.outputs[i]), 1e-9);
  return size;
}

/// A steady state inside the data, near the middle of the inputs' ranges; without one the middle.
NominalPoint nominalOf(LocalModel& local) {
  const TsModel& model = local.model();
  NominalPoint point{partsOf(model.outputs, 0.5), partsOf(model.inputs, 0.5),
                     partsOf(model.disturbances, 0.5)};
  const Vector middle = point.y;
  const Vector size = sizesOf(model);
  for (const double part : kParts) {
    point.u = partsOf(model.inputs, part);
    point.y = middle;
    if (findRest(local, point.u, point.d, size, point.y) && isInside(point.y, model.outputs))
      return point;
  }
  return {middle, partsOf(model.inputs, 0.5), point.d};
}

Quantity quantityOf(const SignalInfo& s, double nominal, double beyond) {
  const double more = beyond * widthOf(s);
  Quantity q{s.name, s.unit.empty() ? "-" : s.unit, nominal, -kNoRange, kNoRange};
  if (isKnown(s)) {
    q.lower = s.lower - more;
    q.upper = s.upper + more;
  }
  q.lower = std::min(q.lower, nominal);
  q.upper = std::max(q.upper, nominal);
  return q;
}

void addQuantities(std::vector<Quantity>& to, const std::vector<SignalInfo>& signals,
                   VectorRef nominal, double beyond) {
  for (std::size_t i = 0; i < signals.size(); ++i)
    to.push_back(quantityOf(signals[i], nominal[static_cast<Index>(i)], beyond));
}

/// Of the loop file: where a signal can be, whatever its data were.
void takeRange(const SignalInfo& range, PlantDescription& p) {
  for (auto* group : {&p.states, &p.inputs, &p.disturbances})
    for (Quantity& q : *group) {
      if (q.name != range.name) continue;
      q.lower = range.lower;
      q.upper = range.upper;
      q.nominal = std::clamp(q.nominal, q.lower, q.upper);
      return;
    }
  throw InputError("plant.ranges." + range.name + ": expected a signal of the model");
}

class ModelStepper final : public PlantStepper {
 public:
  ModelStepper(const TsModel& model, const PlantDescription& about)
      : local_(model), about_(about), past_(Vector::Zero(local_.stateSize())), next_(past_) {
    n_d_ = static_cast<Index>(model.disturbances.size());
    d_ = Vector::Zero(n_d_);
  }
  void reset(VectorRef u, VectorRef d) override {
    start_input_ = u;
    d_ = d.head(n_d_);
    begun_ = false;
  }
  bool divisible() const override { return false; }
  std::string failure() const override { return failure_; }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override {
    if (!begun_) local_.restState(x, start_input_, d_, past_);
    begun_ = true;
    for (Index i = 0; i < x.size(); ++i) past_[local_.outputState(i)] = x[i];
    d_ = d.head(n_d_);
    local_.advance(past_, u, d_, next_);
    past_.swap(next_);
    failure_.clear();
    for (Index i = 0; i < x.size(); ++i) {
      x[i] = past_[local_.outputState(i)] += d[n_d_ + i];
      const Quantity& q = about_.states[static_cast<std::size_t>(i)];
      if (x[i] < q.lower || x[i] > q.upper)
        failure_ = "output " + q.name + " leaves " + exactText(q.lower) + " to " +
                   exactText(q.upper) + " [" + q.unit + "]: the model says nothing of it there";
    }
  }

 private:
  LocalModel local_;
  const PlantDescription& about_;
  Vector start_input_, d_, past_, next_;
  Index n_d_{};
  bool begun_{false};
  std::string failure_;
};

}  // namespace

std::optional<Vector> restOf(const TsModel& model, VectorRef input, VectorRef disturbances) {
  LocalModel local(model);
  Vector y = partsOf(model.outputs, 0.5);
  if (!findRest(local, input, disturbances, sizesOf(model), y)) return std::nullopt;
  return y;
}

ModelNoise noiseOf(const TsModel& model, const ModelErrors& errors, VectorRef outputs,
                   VectorRef input, VectorRef disturbances) {
  const auto n_y = static_cast<Index>(model.outputs.size());
  ModelNoise noise{Vector::Zero(n_y), Vector::Zero(n_y)};
  if (errors.one_step.size() == 0) return noise;
  LocalModel local(model);
  Vector rest(local.stateSize());
  local.restState(outputs, input, disturbances, rest);
  local.blend(rest, input, disturbances);
  const Matrix& A = local.affine().A;
  for (Index i = 0; i < n_y; ++i) {
    const Index row = local.outputState(i);
    const int lags = model.maxLag(SignalKind::kOutput, static_cast<int>(i)) + 1;
    const double past = A.row(row).segment(row, std::max(lags, 1)).squaredNorm();
    Vector state = Vector::Zero(local.stateSize());
    state[row] = 1.0;
    double response = 0.0;
    for (int k = 0; k < kResponseSamples && state.squaredNorm() > kDiedOut; ++k) {
      response += state[row] * state[row];
      state = A * state;
    }
    const double one = errors.one_step[i] * errors.one_step[i],
                 free = errors.free_run[i] * errors.free_run[i];
    const double load = (free * (1.0 + past) - one) / (response * (1.0 + past) - 1.0);
    const double measurement = (one - std::max(load, 0.0)) / (1.0 + past);
    if (std::isfinite(load) && load > 0.0 && measurement >= 0.0) {
      noise.load[i] = std::sqrt(load);
      noise.measurement[i] = std::sqrt(measurement);
    } else if (load <= 0.0) {
      noise.measurement[i] = std::sqrt(one / (1.0 + past));
    } else {
      noise.load[i] = errors.one_step[i];
    }
  }
  return noise;
}

ModelPlant::ModelPlant(TsModel model, const ModelErrors& errors,
                       const std::vector<SignalInfo>& ranges)
    : model_(std::move(model)), local_(model_) {
  const NominalPoint at = nominalOf(local_);
  PlantDescription& p = description_;
  p.name = "model";
  p.title = "Identified model " + model_.name;
  p.time_unit_s = model_.sample_time_s;
  addQuantities(p.states, model_.outputs, at.y, 1.0);
  addQuantities(p.inputs, model_.inputs, at.u, 0.0);
  addQuantities(p.disturbances, model_.disturbances, at.d, 1.0);
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0}};
  for (const SignalInfo& range : ranges) takeRange(range, p);
  const ModelNoise noise = noiseOf(model_, errors, at.y, at.u, at.d);
  for (std::size_t i = 0; i < model_.outputs.size(); ++i) {
    const SignalInfo& y = model_.outputs[i];
    p.outputs.push_back(y.name);
    p.output_frames[y.name] = "plant";
    const double wide = 10.0 * widthOf(y);
    p.disturbances.push_back({"load/" + y.name, p.states[i].unit, 0.0, -wide, wide});
    p.hidden_disturbances.push_back("load/" + y.name);
    p.noise_std[y.name] = noise.measurement[static_cast<Index>(i)];
    p.noise_std["load/" + y.name] = noise.load[static_cast<Index>(i)];
  }
  rest_.resize(local_.stateSize());
}

void ModelPlant::derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const {
  const auto n_d = static_cast<Index>(model_.disturbances.size());
  local_.restState(x, u, d.head(n_d), rest_);
  local_.advance(rest_, u, d.head(n_d), next_);
  dxdt = local_.affine().C * next_ - x + d.tail(x.size());
}

std::unique_ptr<PlantStepper> ModelPlant::makeStepper(double sample_time_s) const {
  require(std::abs(sample_time_s - model_.sample_time_s) <= kSameSampleTime * sample_time_s,
          "sampling.sample_time_s",
          "that of the model, " + exactText(model_.sample_time_s) + ", got " +
              exactText(sample_time_s));
  return std::make_unique<ModelStepper>(model_, description_);
}

}  // namespace fpc
