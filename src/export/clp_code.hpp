// The constraint optimizer of a block: C99 only, as text of its own (clp/), whose sizes and tables
// are the loop's.
#pragma once

#include "export/block.hpp"
#include "fmbpc/control/predictive_law.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// What a law gives the optimizer at each sample, and what it answers: members of clp_t
/// (clp/law.h), where they are explained.
class ClpCode {
 public:
  /// `lead`: samples added to the time at which the law's references are met.
  /// @throws InputError naming what of section clp is not exported.
  ClpCode(BlockParts& parts, const LocalModel& model, const PredictiveLawParams& law, int lead);
  /// What no law computes: limits, setpoints, and what is left of the reference.
  void begin(const ir::Value& reference, const ir::Value& disturbances);
  void run();   ///< answers
  void rest();  ///< did not run at this sample

  ir::Value x, A, B, g, d, offset, K, L, bias, base, least, most;  ///< of the law
  ir::Value previous;                                              ///< of the block
  ir::Value u, source;                                             ///< answered

 private:
  ir::Value member(const std::string& name, int size, ir::Kind kind = ir::Kind::kReal);

  BlockParts& b_;
  ir::Program& p_;
  ir::Value away_, setpoint_, lower_, upper_, move_, status_, iterations_, active_;
  ir::Value most_sets_, status_out_, iterations_out_, active_out_;
};

}  // namespace fpc
