// Can this measurement be true? Each signal is judged by itself: range, rate, jump, freezing (by
// its own noise and resolution). What its instrument or its link does not vouch for has become NaN
// before (noValue).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "supervision/flat_line.hpp"
#include "supervision/plausibility_params.hpp"

namespace fpc {

/// Why a value is not accepted.
enum class Doubt : std::uint8_t {
  kNone,
  kNoNumber,
  kStale,
  kMissing,
  kRange,
  kRate,
  kJump,
  kFrozen,
  kRepeated
};
inline constexpr std::size_t kDoubts = 9;

/// What becomes of a sample.
enum class Verdict : std::uint8_t {
  kClean,     ///< every value is accepted
  kRepaired,  ///< the law gets accepted() instead
  kHold,
  kFallback,
};

/// The outputs that the law expects at a sample; false if it expects nothing.
using Foresee = std::function<bool(Eigen::Ref<Vector>)>;

/// Signals are numbered: outputs, then disturbances. A signal that the law does not need is
/// replaced by its last good value and never holds an input, nor does a disturbance that is frozen.
/// No allocation after the first sample.
class SignalValidator {
 public:
  /// @throws InputError naming the field.
  SignalValidator(PlausibilityParams params, const PlantInfo& plant);
  /// A new run, or samples were lost: rates and jumps are measured from the next sample on.
  void reset();
  void need(std::size_t signal, bool needed) { needed_[signal] = needed; }
  /// `foresee` is asked only for an output in whose place it is needed.
  Verdict look(const Measurement& now, const Foresee& foresee = {});
  /// The sample with every doubted value replaced.
  const Measurement& accepted() const { return accepted_; }
  Doubt doubt(std::size_t signal) const { return signals_[signal].doubt; }
  /// Of the first doubted signal, with what is done about it; lives as long as this object.
  const Notice& notice() const { return notice_; }
  const PlausibilityParams& params() const { return params_; }

 private:
  struct Memory {
    Doubt doubt{Doubt::kNone};
    double good{}, level{};
    std::uint64_t since_good{};  // samples
    int at_level{};
    bool has_good{false}, foreseen{false};
    FlatLine flat;
  };
  Doubt judge(std::size_t i, double value);
  bool isFrozen(std::size_t i, double value) const;
  /// It is frozen, and the loop file does not say what is done.
  bool byDefault(std::size_t i) const;
  bool jumped(Memory& signal, const SignalPlausibility& asked, double value) const;
  Substitute substituteOf(std::size_t signal) const;
  bool expectsFrom(const Foresee& foresee);
  bool replace(std::size_t signal, const Foresee& foresee);
  void say(Verdict verdict);
  void writeTexts(const PlantInfo& plant);

  PlausibilityParams params_;
  std::size_t n_y_;
  double sample_time_h_;
  std::vector<SignalPlausibility> asked_;  // outputs, then disturbances
  std::vector<Memory> signals_;
  std::vector<bool> needed_;
  std::vector<std::vector<std::string>> texts_;  // by signal; by doubt and action
  std::vector<std::string> names_;               // by signal
  Notice notice_;
  Measurement accepted_;
  Vector expected_;
  bool asked_law_{false}, has_expected_{false};  // at this sample
  int doubted_{};  // samples in a row with a doubt about a needed signal
};

}  // namespace fpc
