// A small imperative language: what a block computes in a sample, from which C99 and Structured
// Text are printed. Every operation is in brackets of its own, so both languages round alike.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace fpc::ir {

enum class Kind { kReal, kInt, kBool };
/// Where a variable lives: given and taken each sample, kept between samples, gone afterwards,
/// never changed; a member of what only C has (Native).
enum class Role { kInput, kOutput, kState, kWork, kTable, kArgument, kIndex, kMember };

struct Variable {
  std::string name;
  Kind kind{Kind::kReal};
  Role role{Role::kWork};
  int size{0};                  ///< 0: one number; else an array
  std::vector<double> initial;  ///< one, or `size`; of inputs and states
  std::string meaning{};        ///< with its unit; of inputs and outputs
  bool used{true};              ///< false: not printed
};

enum class Operation {
  kNumber,
  kVariable,
  kElement,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kNegate,
  kRemainder,
  kLess,
  kLessEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kNot,
  kToReal,
  kFloor,
  kCall
};

struct Function;

struct Node {
  Operation operation;
  Kind kind;
  double number{};
  const Variable* variable{};
  const Function* function{};
  std::vector<std::shared_ptr<const Node>> of;
};

/// An expression. Numbers become literals of the kind that the other operand has.
class Value {
 public:
  Value(double number);  // NOLINT: literals are values
  Value(int number);     // NOLINT
  Value(bool flag);      // NOLINT
  explicit Value(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  explicit Value(const Variable& variable);
  Value operator[](const Value& index) const;  ///< element of an array
  const Node& node() const { return *node_; }
  const std::shared_ptr<const Node>& pointer() const { return node_; }
  Kind kind() const { return node_->kind; }

 private:
  std::shared_ptr<const Node> node_;
};

Value operator+(const Value& a, const Value& b);
Value operator-(const Value& a, const Value& b);
Value operator*(const Value& a, const Value& b);
Value operator/(const Value& a, const Value& b);
Value operator%(const Value& a, const Value& b);  ///< of integers, not negative
Value operator-(const Value& a);
Value operator<(const Value& a, const Value& b);
Value operator<=(const Value& a, const Value& b);
Value operator>(const Value& a, const Value& b);
Value operator>=(const Value& a, const Value& b);
Value operator==(const Value& a, const Value& b);
Value operator!=(const Value& a, const Value& b);
Value operator&&(const Value& a, const Value& b);  // both sides may be computed
Value operator||(const Value& a, const Value& b);
Value operator!(const Value& a);
Value literal(double number, Kind kind);
Value toReal(const Value& integer);
Value floorOf(const Value& real);  ///< as an integer; |real| < 2^31

struct Statement;
using Statements = std::vector<Statement>;
struct Statement {
  enum class Form { kAssign, kIf, kFor, kWords, kNative } form;
  std::shared_ptr<const Node> target, value;  ///< value: also the condition
  Statements then, otherwise;                 ///< then: also the body
  const Variable* index{};
  int count{};
  std::string words;
};

/// A function of numbers with memory of its own only while it runs.
struct Function {
  std::string name;
  std::vector<const Variable*> arguments;
  std::deque<Variable> variables;
  const Variable* result{};
  Statements body;
};

constexpr double kLargest = 1e12;  ///< what is beyond is no measurement; states stay inside

/// Text of its own that a block in C needs beside what the program says: types and a member of the
/// state, tables and functions.
struct Native {
  std::string types, member, code;
};

/// The block: its variables, functions, and what it does in a sample.
class Program {
 public:
  std::string name;
  bool single{false};  ///< real numbers have single precision
  double smallestExponent() const { return single ? -80.0 : -700.0; }  ///< exp() of less is 0
  const std::deque<Variable>& variables() const { return variables_; }
  const std::deque<Function>& functions() const { return functions_; }
  const Statements& body() const { return body_; }
  Native native;

  Value input(const std::string& name, Kind kind, double initial, const std::string& meaning);
  Value output(const std::string& name, Kind kind, const std::string& meaning);
  Value state(const std::string& name, Kind kind, double initial = 0.0);
  Value states(const std::string& name, Kind kind, int size, std::vector<double> initial = {});
  Value work(const std::string& name, Kind kind = Kind::kReal);
  Value works(const std::string& name, Kind kind, int size);
  /// The same name and values: the same table.
  Value table(const std::string& name, std::vector<double> values, Kind kind = Kind::kReal);

  /// Part of native.member, "clp.x"; size 0: one number.
  Value member(const std::string& name, Kind kind, int size);

  void set(const Value& target, const Value& value);
  void when(const Value& condition, const std::function<void()>& then,
            const std::function<void()>& otherwise = {});
  /// i = 0 .. count - 1; of one pass there is no loop, since a compiler of Structured Text runs it
  /// zero times.
  void loop(int count, const std::function<void(const Value& i)>& body);
  void words(const std::string& text);
  void statement(const std::string& native);  ///< of C
  /// target := inside [lower, upper]; the upper bound wins.
  void clamp(const Value& target, const Value& lower, const Value& upper);
  void setAbsolute(const Value& target, const Value& value);
  /// target := inside kLargest: what is beyond is of no use, and nothing overflows behind it.
  void contain(const Value& target) { clamp(target, -kLargest, kLargest); }
  /// The same of what is inside wherever it is of use: products overflow in single precision.
  void keepInside(const Value& target) {
    if (single) contain(target);
  }
  /// All states as they begin.
  void initialise();

  Value call(const std::string& function, const Value& argument);  ///< see math.hpp
  /// A function of one number under construction: its statements go there until the end.
  void define(const std::string& name, const std::function<Value(const Value& x)>& body);
  bool defined(const std::string& name) const;
  /// Takes away what is computed for nobody: work that no expression reads, tables, indices.
  void tidy();
  bool uses(Operation operation) const;  ///< anywhere
  int bytesOf(Role role, int real_bytes) const;

 private:
  const Variable& add(Variable variable);
  void inside(Statements& where, const std::function<void()>& build);

  std::deque<Variable> variables_;  // addresses stay
  std::deque<Function> functions_;
  Statements body_;
  Statements* open_{&body_};
  Function* function_{nullptr};
  int loops_{0}, depth_{0};
};

Value sane(const Value& x);       ///< a number within kLargest; no NaN
Value contained(const Value& x);  ///< sane, and not at the bounds where contain() leaves it

}  // namespace fpc::ir
