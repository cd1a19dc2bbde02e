// C99: no heap, no recursion, no library.
#include <algorithm>
#include <cmath>

#include "export/print.hpp"
#include "export/print_expression.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Node;
using ir::Operation;
using ir::Role;
using ir::Statement;
using ir::Variable;

/// What compilers make a call of memset or memcpy.
bool fillsOrCopies(const ir::Statements& statements) {
  return std::any_of(statements.begin(), statements.end(), [](const Statement& s) {
    return s.form == Statement::Form::kAssign && s.value->operation <= Operation::kElement;
  });
}

class CPrinter final : public ExpressionPrinter {
 public:
  explicit CPrinter(const ir::Program& program) : ExpressionPrinter(program) {}

  std::string type(Kind kind) const {
    if (kind == Kind::kReal) return program_.single ? "float" : "double";
    return kind == Kind::kInt ? "int32_t" : "bool";
  }
  std::string number(double value, Kind kind) const {
    if (kind == Kind::kReal)
      return realLiteral(value, program_.single, 'e') + (program_.single ? "f" : "");
    if (kind == Kind::kBool) return value != 0.0 ? "true" : "false";
    return std::to_string(std::lround(value));
  }
  std::string declaration(const Variable& v) const {
    return type(v.kind) + " " + v.name + (v.size > 0 ? "[" + std::to_string(v.size) + "]" : "");
  }

 private:
  std::string literal(const Node& node) const override { return number(node.number, node.kind); }
  std::string variable(const Variable& v) const override {
    if (v.role == Role::kInput) return "in->" + v.name;
    if (v.role == Role::kOutput) return "out->" + v.name;
    if (v.role == Role::kState || v.role == Role::kMember) return "s->" + v.name;
    return v.role == Role::kTable ? program_.name + "_" + v.name : v.name;
  }
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
        return " % ";
      case Operation::kLess:
        return " < ";
      case Operation::kLessEqual:
        return " <= ";
      case Operation::kEqual:
        return " == ";
      case Operation::kNotEqual:
        return " != ";
      case Operation::kAnd:
        return " && ";
      default:
        return " || ";
    }
  }
  std::string negated(const std::string& flag) const override { return "!(" + flag + ")"; }
  std::string toReal(const std::string& inner) const override {
    return "((" + type(Kind::kReal) + ")" + inner + ")";
  }
  std::string called(const std::string& function) const override {
    return program_.name + "_" + function;
  }
  std::string assign(const std::string& to, const std::string& value) const override {
    return to + " = " + value + ";";
  }
  std::string begin(const Statement& s) const override {
    if (s.form == Statement::Form::kIf) return "if (" + bare(*s.value) + ") {";
    const std::string& i = s.index->name;
    return "for (" + i + " = 0; " + i + " < " + std::to_string(s.count) + "; " + i + "++) {" +
           (fillsOrCopies(s.then) ? " " + noCall(program_.name) + ";" : "");
  }
  std::string otherwise() const override { return "} else {"; }
  std::string end(const Statement&) const override { return "}"; }
  std::string comment(const std::string& words) const override { return "/* " + words + " */"; }
};

std::string members(const CPrinter& c, const ir::Program& program, Role role) {
  std::vector<Variable> all;
  for (const Variable& v : program.variables())
    if (v.role == role) all.push_back(v);
  if (role == Role::kState)  // no gaps; the hash stays first: every law looks for it there
    std::stable_sort(all.begin(), all.end(), [](const Variable& a, const Variable& b) {
      const auto rank = [](Kind kind) {
        return kind == Kind::kInt ? 0 : kind == Kind::kReal ? 1 : 2;
      };
      return rank(a.kind) < rank(b.kind);
    });
  std::string text;
  for (const Variable& v : all)
    text += "  " + c.declaration(v) + ";" + (v.meaning.empty() ? "" : " /* " + v.meaning + " */") +
            "\n";
  return role == Role::kState ? text + program.native.member : text;
}

std::string structure(const CPrinter& c, const ir::Program& program, Role role,
                      const std::string& suffix, const std::string& words) {
  return "/* " + words + " */\ntypedef struct {\n" + members(c, program, role) + "} " +
         program.name + "_" + suffix + "_t;\n\n";
}

void printTables(const CPrinter& c, const ir::Program& program, std::string& to) {
  for (const Variable& v : program.variables()) {
    if (v.role != Role::kTable || !v.used) continue;
    Variable named = v;
    named.name = program.name + "_" + v.name;
    to += "static const " + c.declaration(named) + " = {";
    for (std::size_t i = 0; i < v.initial.size(); ++i)
      to += (i == 0 ? "" : ",") + std::string(i % 8 == 0 ? "\n  " : " ") +
            c.number(v.initial[i], v.kind);
    to += "\n};\n";
  }
}

void printFunctions(const CPrinter& c, const ir::Program& program, std::string& to) {
  const std::string real = c.type(Kind::kReal);
  if (program.uses(Operation::kFloor))
    to += "\nstatic int32_t " + program.name + "_floor(" + real +
          " x) {\n  int32_t n = (int32_t)x;\n"
          "  if (((" +
          real + ")n) > x) {\n    n = n - 1;\n  }\n  return n;\n}\n";
  for (const ir::Function& f : program.functions()) {
    to += "\nstatic " + real + " " + program.name + "_" + f.name + "(" + real + " x) {\n";
    for (const Variable& v : f.variables)
      if (v.role != Role::kArgument) to += "  " + c.declaration(v) + ";\n";
    c.print(f.body, 1, to);
    to += "  return " + f.result->name + ";\n}\n";
  }
}

}  // namespace

std::string noCall(const std::string& block) { return upperCase(block) + "_NO_CALL"; }

std::string cHeader(const ir::Program& program, const ExportIdentity& id) {
  const CPrinter c(program);
  const std::string guard = upperCase(program.name) + "_H", upper = upperCase(program.name);
  std::string text = "/* " + id.controller + " of loop " + id.loop + ", by " + id.exporter + ", " +
                     id.date + "\n * hash of model and loop " + id.hash + " */\n";
  text += "#ifndef " + guard + "\n#define " + guard +
          "\n\n#include <stdbool.h>\n#include <stdint.h>\n\n";
  text += "#define " + upper + "_HASH " + std::to_string(id.number) + "\n";
  text += "#define " + upper + "_SAMPLE_TIME_S " + c.number(id.sample_time_s, Kind::kReal) + "\n\n";
  text += structure(c, program, Role::kInput, "in", "What the block is given at each sample.");
  text += structure(c, program, Role::kOutput, "out", "What it answers.");
  text += program.native.types;
  text += structure(c, program, Role::kState, "state",
                    "Memory. All zeros will do: another hash starts the block anew.");
  text += "/* Every input at its default. */\nvoid " + program.name + "_defaults(" + program.name +
          "_in_t *in);\n/* One sample. */\nvoid " + program.name + "_step(" + program.name +
          "_state_t *s, const " + program.name + "_in_t *in, " + program.name + "_out_t *out);\n\n";
  return text + "#endif\n";
}

std::string cSource(const ir::Program& program, const ExportIdentity& id) {
  const CPrinter c(program);
  std::string text = "/* " + id.controller + " of loop " + id.loop + ", by " + id.exporter +
                     ". Compile with -ffp-contract=off. */\n#include \"" + program.name +
                     ".h\"\n\n";
  std::string loops;
  c.print(program.body(), 1, loops);
  const std::string no_call = noCall(program.name);
  if ((loops + program.native.code).find(no_call) != std::string::npos)
    text +=
        "/* Loops that fill and copy stay loops: no call of memset or memcpy. */\n"
        "#if defined(__GNUC__) && !defined(__FRAMAC__)\n#define " +
        no_call + " __asm__ __volatile__(\"\")\n#else\n#define " + no_call +
        " ((void)0)\n#endif\n\n";
  printTables(c, program, text);
  printFunctions(c, program, text);
  text += program.native.code;
  text += "\nvoid " + program.name + "_defaults(" + program.name + "_in_t *in) {\n";
  for (const Variable& v : program.variables())
    if (v.role == Role::kInput)
      text += "  in->" + v.name + " = " + c.number(v.initial[0], v.kind) + ";\n";
  text += "}\n\nvoid " + program.name + "_step(" + program.name + "_state_t *s, const " +
          program.name + "_in_t *in, " + program.name + "_out_t *out) {\n";
  for (const Variable& v : program.variables())
    if (v.used && (v.role == Role::kWork || v.role == Role::kIndex))
      text += "  " + c.declaration(v) + ";\n";
  return text + loops + "}\n";
}

}  // namespace fpc
