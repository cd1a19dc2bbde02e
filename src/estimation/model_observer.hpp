// Where a process stands, estimated with its Takagi-Sugeno model from measurements that are noisy
// and may come late.
#pragma once

#include <vector>

#include "estimation/disturbance_observer.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// Extended Kalman filter on a fuzzy model with one constant disturbance per output: the rules are
/// blended at the estimate, and their matrix stands for the Jacobian. Measurements that are `delay`
/// samples old correct the state of that time; from there the model runs forward on the inputs
/// applied since, with the disturbance estimated. Unmeasured disturbances of the model are rows of
/// its state that nothing moves: taken to be 0 until the start, when they jump, and to walk from
/// there on; where they alone change (disturbance_std 0), to have walked before the start, too,
/// from a rest at outputs that nobody read. Per sample: rest() or advance(). Fixed work, no
/// allocation after construction.
class ModelObserver {
 public:
  /// local: of the undelayed process. delay >= 0 samples. @throws InputError of ObserverParams, and
  /// naming an estimated disturbance that is not an unmeasured one of the model.
  ModelObserver(LocalModel local, const ObserverParams& params, int delay);
  /// Everything has rested at these values: d is what the model lacks to rest there, too.
  /// in_run: it has rested or run in this run before; what it takes unmeasured disturbances for
  /// then stays, else they are 0 until they jump.
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances, bool in_run = false);
  void forget() { begun_ = false; }  ///< the next rest() is as the first one, in a run, too
  /// To sample k: y(k) as measured, u(k-1), d(k-1) as the model takes it.
  void advance(VectorRef outputs, VectorRef input, VectorRef disturbances);
  /// What advance() will expect to be measured.
  void foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs);
  /// Goes on from another one with states of the same meaning and the same delay.
  void inherit(const ModelObserver& other);
  const Vector& state() const { return state_; }  ///< x(k), run forward over the delay
  /// x(k-1) that state() came from, without the forward run; with no delay.
  const Vector& before() const { return before_; }
  /// Of ObserverParams::estimated, now.
  double estimated(std::size_t i) const { return state_[hidden_[i].row]; }
  const Vector& disturbance() const { return filter_.disturbance(); }  ///< n_y, per sample
  const Vector& innovation() const { return filter_.innovation(); }
  void addDisturbance(Eigen::Ref<Vector> state) const { filter_.addDisturbance(state); }
  const Vector& delayed() const { return delayed_; }  ///< x(k - delay), as corrected

 private:
  struct Hidden {
    Eigen::Index row, rows;  ///< in the state
    double std, walk_std;
    int walked;  ///< samples before the start, if it begins moving
  };
  void placeEstimated(const std::vector<EstimatedDisturbance>& estimated);
  void loosen(double Hidden::*std, double times = 1.0);
  void walkToStart();
  void move(VectorRef input, VectorRef disturbances, Vector& state);

  LocalModel local_;
  DisturbanceObserver filter_;
  Vector delayed_, state_, before_, next_;
  Matrix inputs_, disturbances_;  ///< of the last samples, oldest first
  std::vector<Hidden> hidden_;
  Matrix rest_;                  ///< n_x n_y, state at rest of an output 1; empty: not asked for
  Vector most_;                  ///< n_y, variance of a reading anywhere in the range
  Eigen::Index before_start_{};  ///< samples that delayed() is before the start
  bool begun_{false};
};

}  // namespace fpc
