// Expressions and statements as text. Private to the room.
#pragma once

#include <string>

#include "export/ir.hpp"

namespace fpc {

/// What differs between the languages.
class ExpressionPrinter {
 public:
  virtual ~ExpressionPrinter() = default;
  std::string text(const ir::Node& node) const;
  std::string bare(const ir::Node& node) const;  ///< without its outer brackets
  void print(const ir::Statements& statements, int depth, std::string& to) const;

 protected:
  explicit ExpressionPrinter(const ir::Program& program) : program_(program) {}
  virtual std::string literal(const ir::Node& node) const = 0;
  virtual std::string variable(const ir::Variable& variable) const = 0;
  virtual std::string operation(const ir::Node& node) const = 0;  ///< " AND "
  virtual std::string negated(const std::string& flag) const = 0;
  virtual std::string toReal(const std::string& inner) const = 0;
  virtual std::string called(const std::string& function) const = 0;
  virtual std::string assign(const std::string& to, const std::string& value) const = 0;
  virtual std::string begin(const ir::Statement& statement) const = 0;
  virtual std::string otherwise() const = 0;
  virtual std::string end(const ir::Statement& statement) const = 0;
  virtual std::string comment(const std::string& words) const = 0;

  const ir::Program& program_;
};

}  // namespace fpc
