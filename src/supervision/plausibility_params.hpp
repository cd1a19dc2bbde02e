// Section `plausibility` of a loop file: what a measurement may be, and when an input is stuck.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// What the law gets instead of a value that is not accepted.
enum class Substitute : std::uint8_t {
  kHold,      ///< nothing: the input is held
  kLastGood,  ///< the last value that was accepted
  kModel,     ///< what the law expects at this sample; the last good value where it does not
};
inline std::vector<std::string> wordsOf(Substitute) { return {"hold", "last_good", "model"}; }

/// What is asked of one signal. The defaults ask nothing.
struct SignalPlausibility {
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
  double rate_per_h{std::numeric_limits<double>::infinity()};  ///< largest change, from the last
                                                               ///< value that was accepted
  double jump{std::numeric_limits<double>::infinity()};        ///< largest change at once ...
  int jump_samples{3};   ///< ... unless the new level stays for so many samples
  bool frozen{false};    ///< equal readings are doubted where its own noise would change them
  bool repeated{false};  ///< and one that comes twice while the signal moves
  double scale_lower{-std::numeric_limits<double>::infinity()};  ///< ends of the instrument: what
  double scale_upper{std::numeric_limits<double>::infinity()};   ///< stands there may be cut off
  Substitute substitute{Substitute::kHold};
};

/// What is asked of all measured signals.
struct PlausibilityParams {
  bool enabled{false};    ///< without: only what is no number is doubted
  int hold_samples{-1};   ///< so long a needed signal may be doubted, then `fallback`; -1: for ever
  int bridge_samples{0};  ///< so long a doubted signal is replaced as with Substitute::kModel
  bool gain_sign{false};  ///< a new model must have the gains' signs of the running one
  int reaction_samples{0};  ///< window in which the outputs must react to the inputs; 0: not asked
  Vector fallback;          ///< n_u; empty: none, the input is held for ever
  bool range_falls{true};   ///< the fallback follows a value outside its range as well
  std::vector<bool> needs;  ///< outputs, then disturbances: what the law needs; empty: all
  std::vector<SignalPlausibility> outputs,
      disturbances;  ///< in the plant's order; empty: no limits
  /// @throws InputError naming plausibility.KEY.
  void validate(std::size_t n_y, std::size_t n_d, Eigen::Index n_u) const;
};

/// When an input is said not to follow its command.
struct StuckParams {
  int samples{5};          ///< in a row; 0: never
  double tolerance{0.02};  ///< of the input's range
  bool hold{false};        ///< it is held then; otherwise it goes on by its own command
};

}  // namespace fpc
