#include "export/print_expression.hpp"

#include <cctype>
#include <cmath>

#include "base/number.hpp"
#include "export/print.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

using ir::Node;
using ir::Operation;
using ir::Statement;

std::string upperCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string realLiteral(double number, bool single, char exponent) {
  require(std::isfinite(number), "export", "a finite number for a literal");
  std::string text;
  if (single) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(static_cast<float>(number)));
    text = digits;
  } else {
    text = printNumber(number);
  }
  const std::size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) mantissa += ".0";
  if (e == std::string::npos) return mantissa;
  return mantissa + exponent + std::to_string(std::stoi(text.substr(e + 1)));
}

std::string ExpressionPrinter::text(const Node& node) const {
  switch (node.operation) {
    case Operation::kNumber:
      return literal(node);
    case Operation::kVariable:
      return variable(*node.variable);
    case Operation::kElement:
      return variable(*node.variable) + "[" + text(*node.of[0]) + "]";
    case Operation::kNegate:
      return "(-" + text(*node.of[0]) + ")";
    case Operation::kNot:
      return negated(text(*node.of[0]));
    case Operation::kToReal:
      return toReal(text(*node.of[0]));
    case Operation::kFloor:
      return called("floor") + "(" + text(*node.of[0]) + ")";
    case Operation::kCall:
      return called(node.function->name) + "(" + text(*node.of[0]) + ")";
    default:
      return "(" + bare(node) + ")";
  }
}

std::string ExpressionPrinter::bare(const Node& node) const {
  if (node.operation < Operation::kAdd || node.of.size() != 2) return text(node);
  return text(*node.of[0]) + operation(node) + text(*node.of[1]);
}

void ExpressionPrinter::print(const ir::Statements& statements, int depth, std::string& to) const {
  const std::string margin(static_cast<std::size_t>(2 * depth), ' ');
  for (const Statement& s : statements) {
    switch (s.form) {
      case Statement::Form::kAssign:
        to += margin + assign(text(*s.target), bare(*s.value)) + "\n";
        break;
      case Statement::Form::kWords:
        to += margin + comment(s.words) + "\n";
        break;
      case Statement::Form::kNative:
        to += margin + s.words + "\n";
        break;
      default:
        to += margin + begin(s) + "\n";
        print(s.then, depth + 1, to);
        if (!s.otherwise.empty()) {
          to += margin + otherwise() + "\n";
          print(s.otherwise, depth + 1, to);
        }
        to += margin + end(s) + "\n";
    }
  }
}

}  // namespace fpc
