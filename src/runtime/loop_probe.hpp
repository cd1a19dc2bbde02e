// A whole loop, whatever its law and plant, linearised numerically where its run leads it: it comes
// to rest there without noise, then a pulse at each input shows its sensitivity.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/margins.hpp"
#include "config/loop_file.hpp"

namespace fpc {

/// What a loop is asked, and what acts on its plant, at a sample of its run.
struct CoursePoint {
  std::uint32_t step{};
  Vector setpoint;      ///< n_y
  Vector disturbances;  ///< n_d, those that act on the plant
};

/// Setpoints and disturbances of a run, sample by sample.
class LoopCourse {
 public:
  /// @throws InputError for an external plant or an endless run.
  explicit LoopCourse(const LoopFile& loop);
  /// At most `count` of them, each the farthest from those before it, in order of time.
  std::vector<CoursePoint> points(int count) const;
  /// The loop with neither noise nor faults that follows its course up to the point and then stays
  /// there.
  LoopFile stayingAt(const LoopFile& loop, const CoursePoint& point) const;

 private:
  double sample_time_;
  Matrix setpoints_, disturbances_;  // a column a sample
};

enum class ProbeResult {
  kLinear,  ///< `response` is the loop's
  kGrows,   ///< a pulse grows: unstable
  kSwings,  ///< it does not come to rest: period_s, swing
  kHeld,    ///< every input stands at a limit: no feedback
  kBends,   ///< it is not linear there, however small the pulse
  kFailed,  ///< see `words`
};

struct LoopProbe {
  CoursePoint point;
  ProbeResult result{ProbeResult::kFailed};
  std::string words;                      ///< of a failure
  Vector outputs, input;                  ///< at rest (kSwings: the last sample)
  std::vector<bool> at_limit;             ///< of each input
  double growth{};                        ///< per sample, of kGrows
  double period_s{};                      ///< of kSwings; 0: none was found
  Vector swing;                           ///< n_u, of kSwings: largest less smallest input
  std::optional<PulseResponse> response;  ///< inputs in parts of their ranges
};

/// `staying`: see LoopCourse::stayingAt(). Samples: at most 3000 to come to rest and 6400 of
/// response after the point.
LoopProbe probeLoop(const LoopFile& staying, const CoursePoint& point);

}  // namespace fpc
