// How far off a model's predictions are, by horizon, beside those of "it stays as it is".
#pragma once

#include <optional>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// At each sample a prediction starts from what was measured; it is moved on under the inputs and
/// disturbances that came, and compared 1, 2, 4, 8 ... and `horizon` samples later with what was
/// measured then. The mean error one sample ahead, of the last kMemory samples or so, is taken to
/// go on, as laws do. Squares of errors are kept for `capacity` samples. No allocation in look()
/// after the first sample.
class HorizonErrors {
 public:
  static constexpr double kMemory = 10.0;
  /// `model` is matched to the plant; without one only "it stays" is judged.
  /// @throws InputError unless horizon >= 1 and capacity > 0.
  HorizonErrors(const TsModel* model, int horizon, Eigen::Index capacity);
  void reset();
  void interrupt();  ///< a sample was lost or not accepted: predictions begin anew
  void look(const Measurement& now);

  const std::vector<int>& horizons() const { return horizons_; }
  Eigen::Index kept() const { return kept_; }
  /// Squared error of output o at horizon number h of the kept sample k; NaN where none was due.
  double model(Eigen::Index o, std::size_t h, Eigen::Index k) const { return model_[h](o, k); }
  double stays(Eigen::Index o, std::size_t h, Eigen::Index k) const { return stays_[h](o, k); }
  bool hasModel() const { return local_.has_value(); }
  /// Root mean square over outputs, each over its mean square of "it stays", and the kept samples,
  /// of the model's error over that of "it stays"; NaN if nothing was due.
  double ratio(std::size_t h) const;

 private:
  void move(const Measurement& now);

  std::optional<LocalModel> local_;
  std::vector<int> horizons_;
  std::vector<Vector> runs_, offsets_;  // of the predictions on their way, by start
  Matrix past_;                         // n_y H: what was measured at their starts
  Vector state_, next_, before_, predicted_, offset_;
  std::vector<Matrix> model_, stays_;  // of each horizon: n_y N
  std::size_t newest_{};
  int running_{};  // predictions on their way
  Eigen::Index kept_{};
  bool known_{false};
};

}  // namespace fpc
