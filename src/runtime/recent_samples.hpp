// The last samples of a loop, to ask what a model would have foreseen of them.
#pragma once

#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Consecutive samples, the oldest forgotten first.
class RecentSamples {
 public:
  static constexpr int kKept = 40;
  static constexpr int kFewest = 8;  ///< before that nothing is judged

  explicit RecentSamples(const PlantInfo& plant);
  /// A sample was lost or not accepted: those before say nothing of what follows.
  void reset() { count_ = 0; }
  /// Sample k; its input_applied is u(k-1). No allocation.
  void add(const Measurement& now);
  bool enough() const { return count_ >= kFewest; }
  /// n_y: root mean square of the errors one sample ahead over the later half of the samples, of a
  /// model matched to the plant; those before fill its lags. Empty before there are enough.
  Vector errorsOf(const TsModel& model) const;

 private:
  const Measurement& at(int k) const;  ///< 0 is the oldest

  std::vector<Measurement> samples_;
  int count_{}, next_{};
};

}  // namespace fpc
