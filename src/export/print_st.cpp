// Structured Text of IEC 61131-3: a subset that every compiler takes. Flat tables, no pointers, no
// library but conversions of integers.
#include <cmath>

#include "export/print.hpp"
#include "export/print_expression.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Node;
using ir::Operation;
using ir::Role;
using ir::Statement;
using ir::Variable;

class StPrinter final : public ExpressionPrinter {
 public:
  explicit StPrinter(const ir::Program& program) : ExpressionPrinter(program) {}

  std::string type(Kind kind) const {
    if (kind == Kind::kReal) return real();
    return kind == Kind::kInt ? "DINT" : "BOOL";
  }
  std::string real() const { return program_.single ? "REAL" : "LREAL"; }
  std::string number(double value, Kind kind) const {
    if (kind == Kind::kReal) return realLiteral(value, program_.single, 'E');
    if (kind == Kind::kBool) return value != 0.0 ? "TRUE" : "FALSE";
    return std::to_string(std::lround(value));
  }
  std::string type(const Variable& v) const {
    if (v.size == 0) return type(v.kind);
    return "ARRAY[0.." + std::to_string(v.size - 1) + "] OF " + type(v.kind);
  }
  std::string initial(const Variable& v) const {
    if (v.initial.empty()) return "";
    if (v.size == 0) return " := " + number(v.initial[0], v.kind);
    std::string text = " := [";
    for (std::size_t i = 0; i < v.initial.size(); ++i)
      text += (i == 0 ? "" : ",") + std::string(i % 8 == 0 ? "\n    " : " ") +
              number(v.initial[i], v.kind);
    return text + "]";
  }

 private:
  /// Compilers refuse literals in statements that single precision cannot hold; matiec reckons in
  /// double with one that has no type.
  std::string literal(const Node& node) const override {
    const double size = std::abs(node.number);
    require(node.kind != Kind::kReal || size == 0.0 || (size > 1e-37 && size < 1e37), "export",
            "literals that Structured Text can hold");
    const std::string text = number(node.number, node.kind);
    if (node.kind != Kind::kReal || !program_.single) return text;
    return text[0] == '-' ? "-REAL#" + text.substr(1) : "REAL#" + text;
  }
  std::string variable(const Variable& v) const override { return v.name; }
  std::string operation(const Node& node) const override {
    switch (node.operation) {
      case Operation::kAdd:
        return " + ";
      case Operation::kSubtract:
        return " - ";
      case Operation::kMultiply:
        return " * ";
      case Operation::kDivide:
        return " / ";
      case Operation::kRemainder:
        return " MOD ";
      case Operation::kLess:
        return " < ";
      case Operation::kLessEqual:
        return " <= ";
      case Operation::kEqual:
        return " = ";
      case Operation::kNotEqual:
        return " <> ";
      case Operation::kAnd:
        return " AND ";
      default:
        return " OR ";
    }
  }
  /// NOT of an expression is no flag to every compiler.
  std::string negated(const std::string& flag) const override { return "(" + flag + " = FALSE)"; }
  std::string toReal(const std::string& inner) const override {
    return "DINT_TO_" + real() + "(" + inner + ")";
  }
  std::string called(const std::string& function) const override {
    return upperCase(program_.name + "_" + function);
  }
  std::string assign(const std::string& to, const std::string& value) const override {
    return to + " := " + value + ";";
  }
  std::string begin(const Statement& s) const override {
    if (s.form == Statement::Form::kIf) return "IF " + bare(*s.value) + " THEN";
    return "FOR " + s.index->name + " := 0 TO " + std::to_string(s.count - 1) + " DO";
  }
  std::string otherwise() const override { return "ELSE"; }
  std::string end(const Statement& s) const override {
    return s.form == Statement::Form::kIf ? "END_IF;" : "END_FOR;";
  }
  std::string comment(const std::string& words) const override { return "(* " + words + " *)"; }
};

void section(const StPrinter& st, const ir::Program& program, const std::string& head,
             const std::vector<Role>& roles, std::string& to) {
  std::string lines;
  for (const Variable& v : program.variables())
    for (const Role role : roles)
      if (v.role == role && v.used)
        lines += "  " + v.name + " : " + st.type(v) + st.initial(v) + ";" +
                 (v.meaning.empty() ? "" : " (* " + v.meaning + " *)") + "\n";
  if (!lines.empty()) to += head + "\n" + lines + "END_VAR\n";
}

}  // namespace

std::string structuredText(const ir::Program& program, const ExportIdentity& id) {
  const StPrinter st(program);
  const std::string prefix = upperCase(program.name);
  std::string text = "(* " + id.controller + " of loop " + id.loop + ", by " + id.exporter + ", " +
                     id.date + "\n   hash of model and loop " + id.hash + "; call it once every " +
                     realLiteral(id.sample_time_s, false, 'E') + " s *)\n";
  if (program.uses(Operation::kFloor))
    text += "FUNCTION " + prefix + "_FLOOR : DINT\nVAR_INPUT\n  x : " + st.real() +
            ";\nEND_VAR\nVAR\n  n : DINT;\nEND_VAR\n  n := " + st.real() +
            "_TO_DINT(x);\n  IF DINT_TO_" + st.real() +
            "(n) > x THEN\n    n := n - 1;\n  END_IF;\n  " + prefix +
            "_FLOOR := n;\nEND_FUNCTION\n\n";
  for (const ir::Function& f : program.functions()) {
    const std::string name = upperCase(program.name + "_" + f.name);
    text += "FUNCTION " + name + " : " + st.real() + "\nVAR_INPUT\n  x : " + st.real() +
            ";\nEND_VAR\nVAR\n";
    for (const Variable& v : f.variables)
      if (v.role != Role::kArgument) text += "  " + v.name + " : " + st.type(v) + ";\n";
    text += "END_VAR\n";
    st.print(f.body, 1, text);
    text += "  " + name + " := " + f.result->name + ";\nEND_FUNCTION\n\n";
  }
  text += "FUNCTION_BLOCK FB_" + prefix + "\n";
  section(st, program, "VAR_INPUT", {Role::kInput}, text);
  section(st, program, "VAR_OUTPUT", {Role::kOutput}, text);
  section(st, program, "VAR", {Role::kState}, text);
  section(st, program, "VAR", {Role::kWork, Role::kIndex}, text);
  section(st, program, "VAR CONSTANT", {Role::kTable}, text);
  st.print(program.body(), 1, text);
  return text + "END_FUNCTION_BLOCK\n";
}

}  // namespace fpc
