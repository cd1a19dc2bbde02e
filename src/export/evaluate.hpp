// Runs the program of a block as a compiler would, in either precision: what becomes of a law is
// known before it is exported.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "export/ir.hpp"

namespace fpc {

class ProgramRunner {
 public:
  explicit ProgramRunner(const ir::Program& program);  ///< which outlives it
  void give(const std::string& input, double value);
  void step();
  double taken(const std::string& output) const;

 private:
  double& slot(const ir::Node& place);
  double valueOf(const ir::Node& node);
  double rounded(double value) const;
  void run(const ir::Statements& statements);

  const ir::Program& program_;
  std::unordered_map<const ir::Variable*, std::vector<double>> values_;
  std::unordered_map<std::string, const ir::Variable*> names_;
};

}  // namespace fpc
