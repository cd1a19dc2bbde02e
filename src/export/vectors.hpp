// Vectors of an exported block: a loop closed in process under everything that happens to a block,
// with what ControllerSession answers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "export/ir.hpp"

namespace fpc {

/// One row a sample: the block's inputs by name, then the outputs that the process answers with.
class BlockVectors {
 public:
  /// @throws InputError as the block's own building.
  BlockVectors(const LoopFile& loop, const ir::Program& program, std::uint64_t seed, int samples);
  ~BlockVectors();
  const std::vector<std::string>& inputs() const;   ///< names of columns
  const std::vector<std::string>& outputs() const;  ///< rOut_, rActive_, iSource, iState, iErrors
  /// The next sample; valid until the one after it.
  const std::vector<double>& next();
  /// The next samples as CSV with a line of names; the first `kept` rows are kept as numbers too.
  std::string csv(int samples, std::size_t kept, std::vector<std::vector<double>>& rows);

 private:
  struct Run;
  std::unique_ptr<Run> run_;
};

/// Bits of iErrors that the process says as well.
constexpr int kComparedErrors = 1 + 4 + 8 + 32;

}  // namespace fpc
