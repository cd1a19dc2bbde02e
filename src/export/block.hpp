// The function block around an exported law: what ControllerSession does with it in process, as a
// program. Modes, quality of inputs, limits, hand-over, flags.
#pragma once

#include <memory>
#include <string>

#include "config/loop_file.hpp"
#include "export/ir.hpp"

namespace fpc {

/// Output iState of a block.
enum class BlockState {
  kOff = 0,
  kManual = 1,
  kAutomatic = 2,
  kCascade = 3,
  kHeld = 4,
  kFallback = 5
};
/// Bits of output iErrors.
enum BlockError {
  kSampleTimeOff = 1,       ///< by more than a tenth: the input is held
  kInputBad = 2,            ///< a measured value is doubted, or not vouched for
  kLimitsInconsistent = 4,  ///< the input is held
  kActuatorBad = 8,         ///< what the actuator did is no number
  kLawFailed = 16,          ///< nothing finite came out, or the law is singular here
  kSetpointBad = 32,        ///< the last good one counts
};

/// The program of a block, and what its parts share. Arrays follow the order of the loop's signals.
struct BlockParts {
  ir::Program& p;
  const LoopFile& loop;
  int n_y, n_u, n_d;
  ir::Value y, d;                ///< accepted values of this sample
  ir::Value applied;             ///< u(k-1) as the law sees it
  ir::Value setpoint;            ///< in force, clamped and rate-limited
  ir::Value lower, upper, move;  ///< of the inputs
  ir::Value u, ok, source;       ///< what the law answers: ActionSource as a number
  ir::Value expected, foreseen;  ///< outputs that the law expects; whether it expects any
};

class ClpCode;

/// A law as code of the block.
class LawCode {
 public:
  virtual ~LawCode() = default;
  virtual void begin() {}    ///< outputs of the law while it does not run
  virtual void reset() = 0;  ///< Controller::reset(): of a plant that runs
  virtual void foresee() {}  ///< sets expected and foreseen, at every sample
  virtual void step() = 0;   ///< sets u, source and ok; ok is true before
  virtual void signals() {}  ///< outputs of the law, at the end of every sample
  virtual ClpCode* optimizer() { return nullptr; }  ///< of a loop with a section clp
};

/// Builds the whole block into `program`. @throws InputError naming what is not exported.
void buildBlock(const LoopFile& loop, ir::Program& program);

/// The code of a loop's controller. @throws InputError naming it, with the reason.
std::unique_ptr<LawCode> makeLawCode(BlockParts& parts);
/// nullptr for controllers of other types.
std::unique_ptr<LawCode> makePiCode(BlockParts& parts);
std::unique_ptr<LawCode> makeFmbpcCode(BlockParts& parts);
std::unique_ptr<LawCode> makeOptimalCode(BlockParts& parts);
/// u := inside limits_of_u as InputLimits::clip(), moves counted from `previous`.
void clipInputs(BlockParts& parts, const ir::Value& input, const ir::Value& previous);
std::string blockHash(const LoopFile& loop);  ///< of model and loop, hexadecimal
int blockNumber(const LoopFile& loop);        ///< the same in 31 bits
/// A name that both languages take.
std::string plainName(const std::string& name);

}  // namespace fpc
