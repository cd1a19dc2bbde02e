// The newest samples of all that is measured or applied.
#pragma once

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// A ring of samples: outputs, measured disturbances and applied inputs. No allocation after
/// construction. Statistics of one signal are over its newest `samples` samples, at most
/// capacity().
class SignalWindow {
 public:
  SignalWindow() = default;
  SignalWindow(Eigen::Index signals, Eigen::Index samples) : values_(signals, samples) {}
  void clear() { known_ = next_ = 0; }
  void add(const Measurement& now);
  bool holds(Eigen::Index samples) const { return known_ >= samples; }
  Eigen::Index capacity() const { return values_.cols(); }

  double span(Eigen::Index signal, Eigen::Index samples) const;
  double mean(Eigen::Index signal, Eigen::Index samples) const {
    return meanOf(signal, 0, samples);
  }
  /// Variance about the mean, over samples - 1.
  double variance(Eigen::Index signal, Eigen::Index samples) const;
  /// Whether the means of the blocks (an eighth of the samples each) in the older half differ by
  /// more than `change` and what the noise, judged by the steps from sample to sample,
  /// makes of such means. At least eight samples.
  bool meansMove(Eigen::Index signal, Eigen::Index samples, double change) const;

 private:
  double at(Eigen::Index signal, Eigen::Index age) const {
    return values_(signal, (next_ + values_.cols() - 1 - age) % values_.cols());
  }
  double meanOf(Eigen::Index signal, Eigen::Index age, Eigen::Index samples) const;
  double noiseOf(Eigen::Index signal, Eigen::Index age, Eigen::Index samples) const;  ///< variance

  Matrix values_;  // a row per signal
  Eigen::Index known_{}, next_{};
};

}  // namespace fpc
