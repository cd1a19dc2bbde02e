#include "export/ir.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc::ir {
namespace {

using NodePtr = std::shared_ptr<const Node>;

NodePtr numberOf(double number, Kind kind) {
  return std::make_shared<Node>(Node{Operation::kNumber, kind, number, nullptr, nullptr, {}});
}

/// A literal takes the kind of its neighbour.
NodePtr alike(const Value& a, Kind kind) {
  const Node& node = a.node();
  if (node.kind == kind || node.operation != Operation::kNumber) return a.pointer();
  return numberOf(node.number, kind);
}

bool isInteger(const Value& a) {
  return a.node().operation == Operation::kNumber && a.kind() == Kind::kInt;
}

bool isInteger(const Value& a, double number) { return isInteger(a) && a.node().number == number; }

/// Integers that are known beforehand: an index of a table, a loop of one pass.
std::optional<Value> folded(Operation operation, const Value& a, const Value& b) {
  if (operation == Operation::kAdd && isInteger(a, 0)) return b;
  if ((operation == Operation::kAdd || operation == Operation::kSubtract) && isInteger(b, 0))
    return a;
  if (operation == Operation::kMultiply && isInteger(a, 1)) return b;
  if (operation == Operation::kMultiply && isInteger(b, 1)) return a;
  if (!isInteger(a) || !isInteger(b)) return std::nullopt;
  const int x = static_cast<int>(a.node().number), y = static_cast<int>(b.node().number);
  switch (operation) {
    case Operation::kAdd:
      return Value(x + y);
    case Operation::kSubtract:
      return Value(x - y);
    case Operation::kMultiply:
      return Value(x * y);
    case Operation::kLess:
      return Value(x < y);
    case Operation::kLessEqual:
      return Value(x <= y);
    case Operation::kEqual:
      return Value(x == y);
    default:
      return std::nullopt;
  }
}

bool isFlag(const Value& a, bool flag) {
  return a.node().operation == Operation::kNumber && a.kind() == Kind::kBool &&
         (a.node().number != 0.0) == flag;
}

Value binary(Operation operation, const Value& a, const Value& b, bool compares = false) {
  if (a.kind() == Kind::kInt && b.kind() == Kind::kInt)
    if (const auto known = folded(operation, a, b)) return *known;
  if (operation == Operation::kAnd || operation == Operation::kOr) {
    const bool neutral = operation == Operation::kAnd;
    if (isFlag(a, neutral) || isFlag(b, !neutral)) return b;
    if (isFlag(b, neutral) || isFlag(a, !neutral)) return a;
  }
  const bool real = a.kind() == Kind::kReal || b.kind() == Kind::kReal;
  const Kind kind = real ? Kind::kReal : a.kind();
  std::vector<NodePtr> of{alike(a, kind), alike(b, kind)};
  require(of[0]->kind == of[1]->kind, "export", "operands of one kind");
  return Value(std::make_shared<Node>(
      Node{operation, compares ? Kind::kBool : kind, 0.0, nullptr, nullptr, std::move(of)}));
}

Value unary(Operation operation, Kind kind, const Value& a) {
  return Value(std::make_shared<Node>(Node{operation, kind, 0.0, nullptr, nullptr, {a.pointer()}}));
}

std::vector<double> filled(std::vector<double> values, int size) {
  values.resize(static_cast<std::size_t>(size), 0.0);
  return values;
}

/// Structured Text does not tell A from a.
bool sameName(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

void visit(const Node& node, const std::function<void(const Node&)>& see) {
  see(node);
  for (const NodePtr& inner : node.of) visit(*inner, see);
}

/// What statements read: values, conditions, indices of the elements that they set.
void visitRead(const Statements& statements, const std::function<void(const Node&)>& see) {
  for (const Statement& s : statements) {
    if (s.value) visit(*s.value, see);
    if (s.target)
      for (const NodePtr& inner : s.target->of) visit(*inner, see);
    visitRead(s.then, see);
    visitRead(s.otherwise, see);
  }
}

bool isVain(const Statement& s, const std::set<const Variable*>& read) {
  if (s.form == Statement::Form::kAssign)
    return s.target->variable->role == Role::kWork && read.count(s.target->variable) == 0;
  return (s.form == Statement::Form::kIf || s.form == Statement::Form::kFor) && s.then.empty() &&
         s.otherwise.empty();
}

bool dropVain(Statements& statements, const std::set<const Variable*>& read) {
  bool dropped = false;
  for (Statement& s : statements) {
    dropped = dropVain(s.then, read) || dropped;
    dropped = dropVain(s.otherwise, read) || dropped;
  }
  const auto vain = [&](const Statement& s) { return isVain(s, read); };
  const auto end = std::remove_if(statements.begin(), statements.end(), vain);
  dropped = dropped || end != statements.end();
  statements.erase(end, statements.end());
  return dropped;
}

void visitLoops(const Statements& statements, std::set<const Variable*>& indices) {
  for (const Statement& s : statements) {
    if (s.index) indices.insert(s.index);
    visitLoops(s.then, indices);
    visitLoops(s.otherwise, indices);
  }
}

}  // namespace

Value::Value(double number) : node_(numberOf(number, Kind::kReal)) {}
Value::Value(int number) : node_(numberOf(number, Kind::kInt)) {}
Value::Value(bool flag) : node_(numberOf(flag ? 1.0 : 0.0, Kind::kBool)) {}
Value::Value(const Variable& variable)
    : node_(std::make_shared<Node>(
          Node{Operation::kVariable, variable.kind, 0.0, &variable, nullptr, {}})) {}

Value Value::operator[](const Value& index) const {
  require(node_->operation == Operation::kVariable && node_->variable->size > 0, "export",
          "an array to take an element of");
  return Value(std::make_shared<Node>(
      Node{Operation::kElement, node_->kind, 0.0, node_->variable, nullptr, {index.pointer()}}));
}

Value operator+(const Value& a, const Value& b) { return binary(Operation::kAdd, a, b); }
Value operator-(const Value& a, const Value& b) { return binary(Operation::kSubtract, a, b); }
Value operator*(const Value& a, const Value& b) { return binary(Operation::kMultiply, a, b); }
Value operator/(const Value& a, const Value& b) { return binary(Operation::kDivide, a, b); }
Value operator%(const Value& a, const Value& b) { return binary(Operation::kRemainder, a, b); }
Value operator-(const Value& a) { return unary(Operation::kNegate, a.kind(), a); }
Value operator<(const Value& a, const Value& b) { return binary(Operation::kLess, a, b, true); }
Value operator<=(const Value& a, const Value& b) {
  return binary(Operation::kLessEqual, a, b, true);
}
Value operator>(const Value& a, const Value& b) { return b < a; }
Value operator>=(const Value& a, const Value& b) { return b <= a; }
Value operator==(const Value& a, const Value& b) { return binary(Operation::kEqual, a, b, true); }
Value operator!=(const Value& a, const Value& b) {
  return binary(Operation::kNotEqual, a, b, true);
}
Value operator&&(const Value& a, const Value& b) { return binary(Operation::kAnd, a, b, true); }
Value operator||(const Value& a, const Value& b) { return binary(Operation::kOr, a, b, true); }
Value operator!(const Value& a) { return unary(Operation::kNot, Kind::kBool, a); }
Value literal(double number, Kind kind) { return Value(numberOf(number, kind)); }
Value toReal(const Value& integer) { return unary(Operation::kToReal, Kind::kReal, integer); }
Value floorOf(const Value& real) { return unary(Operation::kFloor, Kind::kInt, real); }
Value sane(const Value& x) { return -kLargest <= x && x <= Value(kLargest); }
Value contained(const Value& x) { return -kLargest < x && x < Value(kLargest); }

const Variable& Program::add(Variable variable) {
  auto& home = function_ ? function_->variables : variables_;
  for (const Variable& other : home)
    require(!sameName(other.name, variable.name), "export",
            "names that differ by more than their case: " + other.name + ", " + variable.name);
  home.push_back(std::move(variable));
  return home.back();
}

Value Program::input(const std::string& called, Kind kind, double initial,
                     const std::string& meaning) {
  return Value(add({called, kind, Role::kInput, 0, {initial}, meaning}));
}
Value Program::output(const std::string& called, Kind kind, const std::string& meaning) {
  return Value(add({called, kind, Role::kOutput, 0, {0.0}, meaning}));
}
Value Program::state(const std::string& called, Kind kind, double initial) {
  return Value(add({called, kind, Role::kState, 0, {initial}, ""}));
}
Value Program::states(const std::string& called, Kind kind, int size, std::vector<double> initial) {
  return Value(add({called, kind, Role::kState, size, filled(std::move(initial), size), ""}));
}
Value Program::work(const std::string& called, Kind kind) {
  return Value(add({called, kind, Role::kWork, 0, {}, ""}));
}
Value Program::works(const std::string& called, Kind kind, int size) {
  return Value(add({called, kind, Role::kWork, size, {}, ""}));
}
Value Program::table(const std::string& called, std::vector<double> values, Kind kind) {
  const int size = static_cast<int>(values.size());
  for (const Variable& v : variables_)
    if (v.name == called && v.role == Role::kTable && v.initial == values) return Value(v);
  return Value(add({called, kind, Role::kTable, size, std::move(values), ""}));
}

Value Program::member(const std::string& called, Kind kind, int size) {
  return Value(add({called, kind, Role::kMember, size, {}, ""}));
}

void Program::set(const Value& target, const Value& value) {
  Statement statement{Statement::Form::kAssign,
                      target.pointer(),
                      alike(value, target.kind()),
                      {},
                      {},
                      nullptr,
                      0,
                      ""};
  require(statement.value->kind == target.kind(), "export", "a value of the target's kind");
  open_->push_back(std::move(statement));
}

void Program::inside(Statements& where, const std::function<void()>& build) {
  Statements* before = open_;
  open_ = &where;
  build();
  open_ = before;
}

void Program::when(const Value& condition, const std::function<void()>& then,
                   const std::function<void()>& otherwise) {
  if (isFlag(condition, true)) return then();
  if (isFlag(condition, false)) return otherwise ? otherwise() : void();
  Statement statement{Statement::Form::kIf, nullptr, condition.pointer(), {}, {}, nullptr, 0, ""};
  inside(statement.then, then);
  if (otherwise) inside(statement.otherwise, otherwise);
  open_->push_back(std::move(statement));
}

void Program::loop(int count, const std::function<void(const Value& i)>& body) {
  if (count <= 0) return;
  if (count == 1) return body(Value(0));
  ++depth_;
  auto& home = function_ ? function_->variables : variables_;
  const std::string index = "i" + std::to_string(depth_);
  const auto found =
      std::find_if(home.begin(), home.end(), [&](const Variable& v) { return v.name == index; });
  const Variable& variable =
      found != home.end() ? *found : add({index, Kind::kInt, Role::kIndex, 0, {}, ""});
  Statement statement{Statement::Form::kFor, nullptr, nullptr, {}, {}, &variable, count, ""};
  inside(statement.then, [&] { body(Value(variable)); });
  open_->push_back(std::move(statement));
  --depth_;
}

void Program::words(const std::string& text) {
  open_->push_back({Statement::Form::kWords, nullptr, nullptr, {}, {}, nullptr, 0, text});
}

void Program::statement(const std::string& text) {
  open_->push_back({Statement::Form::kNative, nullptr, nullptr, {}, {}, nullptr, 0, text});
}

void Program::clamp(const Value& target, const Value& lower, const Value& upper) {
  when(target < lower, [&] { set(target, lower); });
  when(target > upper, [&] { set(target, upper); });
}

void Program::setAbsolute(const Value& target, const Value& value) {
  set(target, value);
  when(target < 0.0, [&] { set(target, -target); });
}

void Program::initialise() {
  for (std::size_t k = 0; k < variables_.size(); ++k) {
    const Variable& v = variables_[k];
    if (v.role != Role::kState) continue;
    if (v.size == 0) {
      set(Value(v), literal(v.initial[0], v.kind));
      continue;
    }
    const bool same = std::all_of(v.initial.begin(), v.initial.end(),
                                  [&](double number) { return number == v.initial[0]; });
    if (same)
      loop(v.size, [&](const Value& i) { set(Value(v)[i], literal(v.initial[0], v.kind)); });
    else
      for (int i = 0; i < v.size; ++i)
        set(Value(v)[i], literal(v.initial[static_cast<std::size_t>(i)], v.kind));
  }
}

bool Program::defined(const std::string& called) const {
  return std::any_of(functions_.begin(), functions_.end(),
                     [&](const Function& f) { return f.name == called; });
}

void Program::define(const std::string& function,
                     const std::function<Value(const Value& x)>& body) {
  functions_.push_back({function, {}, {}, nullptr, {}});
  function_ = &functions_.back();
  const int depth = std::exchange(depth_, 0);
  const Variable& x = add({"x", Kind::kReal, Role::kArgument, 0, {}, ""});
  function_->arguments = {&x};
  inside(function_->body, [&] {
    const Value result = body(Value(x));
    require(result.node().variable != nullptr, "export", "a variable for a result");
    function_->result = result.node().variable;
  });
  function_ = nullptr;
  depth_ = depth;
}

Value Program::call(const std::string& function, const Value& argument) {
  for (const Function& f : functions_)
    if (f.name == function)
      return Value(std::make_shared<Node>(
          Node{Operation::kCall, Kind::kReal, 0.0, nullptr, &f, {argument.pointer()}}));
  require(false, "export", "the function " + function);
  return argument;
}

void Program::tidy() {
  std::set<const Variable*> read;
  bool again = true;
  while (again) {
    read.clear();
    visitRead(body_, [&](const Node& node) {
      if (node.variable) read.insert(node.variable);
    });
    again = dropVain(body_, read);
  }
  visitLoops(body_, read);
  for (Variable& v : variables_)
    if (v.role == Role::kWork || v.role == Role::kTable || v.role == Role::kIndex)
      v.used = read.count(&v) > 0;
}

bool Program::uses(Operation operation) const {
  bool found = false;
  const auto see = [&](const Node& node) { found = found || node.operation == operation; };
  visitRead(body_, see);
  for (const Function& f : functions_) visitRead(f.body, see);
  return found;
}

int Program::bytesOf(Role role, int real_bytes) const {
  int sum = 0;
  for (const Variable& v : variables_)
    if (v.role == role && v.used)
      sum += std::max(v.size, 1) * (v.kind == Kind::kReal  ? real_bytes
                                    : v.kind == Kind::kInt ? 4
                                                           : 1);
  return sum;
}

}  // namespace fpc::ir
