// How much of what a model did not foresee is disturbance, and how much is noise: a Kalman filter
// over the model's state and one constant disturbance per output, or per input.
#pragma once

#include <Eigen/Cholesky>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Changes per sample that an estimate is uncertain by where it starts.
constexpr double kUnknownChanges = 10.0;

/// A disturbance that the model knows and nobody measures.
struct EstimatedDisturbance {
  std::string name;
  double std{};       ///< of its jump from 0 when a run starts, > 0; where disturbance_std is 0
                      ///< and it walks: as far as it has walked before the start
  double walk_std{};  ///< of its change per sample
};

/// Section `controller.observer`.
struct ObserverParams {
  Vector noise_std;        ///< n_y, of the measurements; 0: all of an error is disturbance
  Vector disturbance_std;  ///< n_y, of the change of d per sample; 0: d stays as at the start,
                           ///< where disturbances of the model are estimated
  std::vector<EstimatedDisturbance> estimated;  ///< by observers on a model
  Vector input_std;  ///< n_u: d adds to the inputs instead and changes by this; empty: not
  bool noisy() const { return noise_std.any(); }
  bool atInputs() const { return input_std.size() > 0; }
  /// Nothing but the model's disturbances changes, and they have done so before the start.
  bool beginsMoving() const;
  /// @throws InputError naming controller.observer.KEY.
  void validate(Eigen::Index n_y) const;
};

/// For x(k+1) = A x + B u + g + E d, d(k+1) = d + w, y = C x + v, where the outputs are rows of x
/// and E adds d to them: covariances and gains; the caller moves the state. Per sample predict()
/// with the A that led from k-1 to k, then correct(). Without noise the corrected output is the
/// measurement and d takes all of the error, as from raw differences. With input_std d adds to the
/// inputs, E = dx(k+1)/du, and takes the change of d per sample from there. Joseph's form; fixed
/// work, no allocation. Source: kalman1960; the disturbance model is muske2002.
/// Symbols: P covariance of (x, d), S = C P C' + R of the innovation, K gain.
class DisturbanceObserver {
 public:
  /// output_rows: row of each output in x. @throws InputError as ObserverParams::validate().
  DisturbanceObserver(ObserverParams params, Eigen::Index n_x,
                      std::vector<Eigen::Index> output_rows);
  /// d = 0; the state is known as well as the measurements are, the disturbance badly.
  void reset();
  /// The same, but for the state: its covariance is root root', root n_x m.
  void reset(MatrixRef root);
  /// After reset(): d = its rows of `shortfall`, n_x, what the model lacks to rest.
  void startFrom(VectorRef shortfall);
  void predict(const Matrix& A);
  /// With disturbances at the inputs. E: n_x n_u.
  void predict(const Matrix& A, const Matrix& E);
  /// Nothing is uncertain: a process that rests, wherever.
  void beCertain() { P_.setZero(); }
  /// The process rested at outputs that nobody read, and has moved since as P says: now they are
  /// read. rest: n_x n_y, the state at rest of an output 1; d is what A lacks to rest there.
  void readAfterRest(const Matrix& rest, const Matrix& A);
  double variance(Eigen::Index row) const { return P_(row, row); }
  /// This row of the state is less certain by so much.
  void loosen(Eigen::Index row, double std) { P_(row, row) += std * std; }
  /// state: x(k|k-1), d(k-1) already in it; becomes x(k|k). Not finite: nothing changes, false.
  bool correct(VectorRef outputs, Eigen::Ref<Vector> state);
  const Vector& disturbance() const { return disturbance_; }  ///< n_y or n_u, d(k|k)
  const Vector& innovation() const { return innovation_; }    ///< n_y, y - C x(k|k-1)
  const Matrix& gain() const { return K_; }                   ///< (n_x + n_y) n_y
  /// x += E d, in place; of disturbances at the outputs.
  void addDisturbance(Eigen::Ref<Vector> state) const;

 private:
  const Vector& change() const {
    return params_.atInputs() ? params_.input_std : params_.disturbance_std;
  }
  bool computeGain();
  void applyGain();  // on P, Joseph's form

  ObserverParams params_;
  Eigen::Index n_x_, n_y_, n_d_;
  std::vector<Eigen::Index> rows_;
  Matrix F_, P_, PF_, PC_, S_, K_, IKC_;
  Vector R_, disturbance_, innovation_, correction_;
  Eigen::LDLT<Matrix> factor_;
};

}  // namespace fpc
