#include "export/evaluate.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

using ir::Kind;
using ir::Node;
using ir::Operation;
using ir::Statement;

ProgramRunner::ProgramRunner(const ir::Program& program) : program_(program) {
  const auto add = [&](const ir::Variable& v) {
    std::vector<double>& values = values_[&v];
    values = v.initial;
    values.resize(static_cast<std::size_t>(std::max(v.size, 1)), 0.0);
    if (v.kind == Kind::kReal)
      for (double& value : values) value = rounded(value);
  };
  for (const ir::Variable& v : program.variables()) {
    add(v);
    names_[v.name] = &v;
  }
  for (const ir::Function& f : program.functions())
    for (const ir::Variable& v : f.variables) add(v);
}

double ProgramRunner::rounded(double value) const {
  return program_.single ? static_cast<double>(static_cast<float>(value)) : value;
}

void ProgramRunner::give(const std::string& input, double value) {
  const ir::Variable* v = names_.at(input);
  values_[v][0] = v->kind == Kind::kReal ? rounded(value) : value;
}

double ProgramRunner::taken(const std::string& output) const {
  return values_.at(names_.at(output))[0];
}

void ProgramRunner::step() { run(program_.body()); }

double& ProgramRunner::slot(const Node& place) {
  std::vector<double>& values = values_.find(place.variable)->second;
  if (place.operation == Operation::kVariable) return values[0];
  return values.at(static_cast<std::size_t>(valueOf(*place.of[0])));
}

double ProgramRunner::valueOf(const Node& node) {
  switch (node.operation) {
    case Operation::kNumber:
      return node.kind == Kind::kReal ? rounded(node.number) : node.number;
    case Operation::kVariable:
    case Operation::kElement:
      return slot(node);
    case Operation::kCall: {
      values_[node.function->arguments.front()][0] = valueOf(*node.of[0]);
      run(node.function->body);
      return values_[node.function->result][0];
    }
    default:
      break;
  }
  const double a = valueOf(*node.of[0]);
  const double b = node.of.size() > 1 ? valueOf(*node.of[1]) : 0.0;
  const auto real = [&](double value) { return node.kind == Kind::kReal ? rounded(value) : value; };
  switch (node.operation) {
    case Operation::kAdd:
      return real(a + b);
    case Operation::kSubtract:
      return real(a - b);
    case Operation::kMultiply:
      return real(a * b);
    case Operation::kDivide:
      return node.kind == Kind::kReal ? rounded(a / b) : std::trunc(a / b);
    case Operation::kRemainder:
      return std::fmod(a, b);
    case Operation::kNegate:
      return -a;
    case Operation::kLess:
      return a < b ? 1.0 : 0.0;
    case Operation::kLessEqual:
      return a <= b ? 1.0 : 0.0;
    case Operation::kEqual:
      return a == b ? 1.0 : 0.0;
    case Operation::kNotEqual:
      return a != b ? 1.0 : 0.0;
    case Operation::kAnd:
      return a != 0.0 && b != 0.0 ? 1.0 : 0.0;
    case Operation::kOr:
      return a != 0.0 || b != 0.0 ? 1.0 : 0.0;
    case Operation::kNot:
      return a == 0.0 ? 1.0 : 0.0;
    case Operation::kFloor:
      return std::floor(a);
    default:
      return rounded(a);  // kToReal
  }
}

void ProgramRunner::run(const ir::Statements& statements) {
  for (const Statement& s : statements) {
    if (s.form == Statement::Form::kAssign) {
      const double value = valueOf(*s.value);
      slot(*s.target) = value;
    } else if (s.form == Statement::Form::kIf) {
      run(valueOf(*s.value) != 0.0 ? s.then : s.otherwise);
    } else if (s.form == Statement::Form::kFor) {
      double& index = values_.find(s.index)->second[0];
      for (int i = 0; i < s.count; ++i) {
        index = i;
        run(s.then);
      }
    }
  }
}

}  // namespace fpc
