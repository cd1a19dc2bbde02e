// An exported block as text: C99, or Structured Text of IEC 61131-3.
#pragma once

#include <string>

#include "export/ir.hpp"

namespace fpc {

/// Texts that name what the block is.
struct ExportIdentity {
  std::string loop, controller, exporter, date, hash;  ///< hash: of model and loop, hexadecimal
  int number{};                                        ///< the same in 31 bits
  double sample_time_s{};
};

std::string cHeader(const ir::Program& program, const ExportIdentity& identity);
std::string cSource(const ir::Program& program, const ExportIdentity& identity);
std::string structuredText(const ir::Program& program, const ExportIdentity& identity);
std::string realLiteral(double number, bool single, char exponent);  ///< "1.0E-5"
std::string upperCase(std::string text);
std::string noCall(const std::string& block);  ///< macro that keeps a loop from becoming a call

}  // namespace fpc
