#include "config/plant_sample_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "plant/quantity_index.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kRestSamples = 10000;
constexpr int kNewtonSteps = 30;
constexpr double kDifference = 1e-6;   // relative, of finite differences
constexpr double kWholeSample = 1e-6;  // of a sample
constexpr double kStill = 1e-12;       // relative change of a state that rests

/// All outputs are measured so many samples late.
int delayOf(const SimulationParams& params, const std::string& where) {
  int delay = 0;
  for (const double& late : params.output_delay_s) {
    const double samples = late / params.sample_time_s;
    const auto whole = static_cast<int>(std::lround(samples));
    require(std::abs(samples - whole) < kWholeSample, where, "delays of whole samples");
    require(&late == params.output_delay_s.data() || whole == delay, where,
            "outputs that are measured equally late");
    delay = whole;
  }
  return delay;
}

class PlantSampleModel final : public SampleModel {
 public:
  PlantSampleModel(const SimulationParams& given, int integration_steps)
      : plant_(makePlant(given)), steps_(integration_steps) {
    const PlantDescription& about = plant_->description();
    const SimulationParams params = checked(given, *plant_);
    stepper_ = plant_->makeStepper(params.sample_time_s);
    const std::string where = "controller.type nmpc with plant " + about.name;
    require(!stepper_ || !stepper_->remembers(), where,
            "a plant whose states say everything: this one has dead times or other memory");
    delay_ = delayOf(params, where);
    step_ = params.sample_time_s / about.time_unit_s / integration_steps;
    for (const auto& name : params.outputs) {
      outputs_.push_back(indexOf(about.states, name));
      require(outputs_.back() < static_cast<Index>(about.states.size()), where,
              "measured states: " + name + " is an algebraic output");
    }
    for (const auto& name : params.measured_disturbances)
      measured_.push_back(indexOf(about.disturbances, name));
    for (std::size_t i = 0; i < about.states.size(); ++i)
      if (std::find(outputs_.begin(), outputs_.end(), static_cast<Index>(i)) == outputs_.end())
        hidden_.push_back(static_cast<Index>(i));
    nominal_ = params.initial_state;
    d_ = params.disturbance_nominal;
    n_ = nominal_.size();
    for (Vector* v : {&x_, &start_, &sum_, &rate_, &point_}) *v = Vector::Zero(n_);
    const auto hidden = static_cast<Index>(hidden_.size());
    moved_ = Vector::Zero(2 * n_);
    drift_ = shifted_ = Vector::Zero(hidden);
    jacobian_ = Matrix::Zero(hidden, hidden);
    lu_ = Eigen::PartialPivLU<Matrix>(hidden);
  }

  int delaySteps() const override { return delay_; }
  Index stateSize() const override { return 2 * n_; }
  Index outputState(Index output) const override {
    return outputs_[static_cast<std::size_t>(output)];
  }

  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
            Eigen::Ref<Vector> state) override {
    start(outputs, state);
    if (!hidden_.empty() && !solveRest(input, disturbances, state)) {
      start(outputs, state);
      settle(outputs, input, disturbances, state);
    }
  }

  bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) override {
    for (std::size_t i = 0; i < measured_.size(); ++i)
      d_[measured_[i]] = disturbances[static_cast<Index>(i)];
    x_ = state.head(n_);
    passLocalLoop(input, state.tail(n_));
    state.tail(n_) = x_;
    if (stepper_)
      stepper_->advance(x_, u_, d_);
    else
      for (int i = 0; i < steps_; ++i) moveByRungeKutta();
    state.head(n_) = x_;
    return x_.allFinite();
  }

 private:
  void start(VectorRef outputs, Eigen::Ref<Vector> state) const {
    state.head(n_) = nominal_;
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      state[outputs_[i]] = outputs[static_cast<Index>(i)];
    state.tail(n_) = state.head(n_);
  }

  /// What a sample adds to the hidden states at rest.
  bool drift(VectorRef input, VectorRef disturbances, VectorRef state, Vector& change) {
    moved_ = state;
    if (!step(input, disturbances, moved_)) return false;
    for (std::size_t i = 0; i < hidden_.size(); ++i)
      change[static_cast<Index>(i)] = moved_[hidden_[i]] - state[hidden_[i]];
    return change.allFinite();
  }

  bool takeJacobian(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) {
    for (std::size_t j = 0; j < hidden_.size(); ++j) {
      const Index row = hidden_[j];
      const double at = state[row], h = kDifference * std::max(kDifference, std::abs(at));
      state[row] = state[n_ + row] = at + h;
      if (!drift(input, disturbances, state, shifted_)) return false;
      state[row] = state[n_ + row] = at;
      jacobian_.col(static_cast<Index>(j)) = (shifted_ - drift_) / h;
    }
    return true;
  }

  bool isPossible(Index row, double value) const {
    const Quantity& known = plant_->description().states[static_cast<std::size_t>(row)];
    return value >= known.lower && value <= known.upper;
  }

  /// Newton's method on the hidden states, the measured ones held: also where they would run away
  /// by themselves. False if it does not end at states that the plant can have.
  bool solveRest(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) {
    for (int k = 0; k < kNewtonSteps; ++k) {
      if (!drift(input, disturbances, state, drift_)) return false;
      if (!takeJacobian(input, disturbances, state)) return false;
      lu_.compute(jacobian_);
      shifted_ = lu_.solve(drift_);
      bool still = true;
      for (std::size_t i = 0; i < hidden_.size(); ++i) {
        const Index row = hidden_[i];
        const double change = shifted_[static_cast<Index>(i)];
        state[row] -= change;
        state[n_ + row] = state[row];
        if (!isPossible(row, state[row])) return false;
        still = still && std::abs(change) <= kStill * std::abs(state[row]);
      }
      if (still) return true;
    }
    return false;
  }

  /// The hidden states by themselves, the measured ones held.
  void settle(VectorRef outputs, VectorRef input, VectorRef disturbances,
              Eigen::Ref<Vector> state) {
    for (int k = 0; k < kRestSamples; ++k) {
      if (!step(input, disturbances, state)) break;
      bool still = true;
      for (const Index i : hidden_)
        still = still && std::abs(state[i] - state[n_ + i]) <= kStill * std::abs(state[i]);
      for (std::size_t i = 0; i < outputs_.size(); ++i)
        state[outputs_[i]] = outputs[static_cast<Index>(i)];
      state.tail(n_) = state.head(n_);
      if (still) break;
    }
  }

  void passLocalLoop(VectorRef input, VectorRef before) {
    u_ = input;
    plant_->localLoop(x_, before, u_);
    const auto& ranges = plant_->description().inputs;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      double& u = u_[static_cast<Index>(i)];
      u = std::clamp(u, ranges[i].lower, ranges[i].upper);
    }
  }

  void moveByRungeKutta() {
    constexpr double kPlace[] = {0.0, 0.5, 0.5, 1.0}, kWeight[] = {1.0, 2.0, 2.0, 1.0};
    start_ = x_;
    sum_.setZero();
    for (int i = 0; i < 4; ++i) {
      point_ = start_;
      if (i > 0) point_ += kPlace[i] * step_ * rate_;
      plant_->derivatives(point_, u_, d_, rate_);
      sum_ += kWeight[i] * rate_;
    }
    x_ = start_ + step_ / 6.0 * sum_;
  }

  std::unique_ptr<Plant> plant_;
  std::unique_ptr<PlantStepper> stepper_;
  int steps_, delay_{};
  double step_{};  // of Runge and Kutta, in the plant's time unit
  Index n_{};
  std::vector<Index> outputs_, measured_, hidden_;
  Vector nominal_, d_, u_, x_, start_, sum_, rate_, point_;
  Vector moved_, drift_, shifted_;  // of the search for rest
  Matrix jacobian_;
  Eigen::PartialPivLU<Matrix> lu_;
};

}  // namespace

std::unique_ptr<SampleModel> makePlantSampleModel(const SimulationParams& params,
                                                  int integration_steps) {
  return std::make_unique<PlantSampleModel>(params, integration_steps);
}

}  // namespace fpc
