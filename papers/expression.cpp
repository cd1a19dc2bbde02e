#include "papers/expression.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "fmbpc/base/input_error.hpp"

namespace fpc::papers {
namespace {

struct Registered {
  std::size_t arguments;
  Computation compute;
};

std::map<std::string, Registered>& registry() {
  static std::map<std::string, Registered> all;
  return all;
}

template <typename Operation>
Values combined(const Values& a, const Values& b, Operation operation) {
  require(a.count() == b.count() || a.count() == 1 || b.count() == 1, "values of several runs",
          "equally many of both");
  std::vector<double> all(std::max(a.count(), b.count()));
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = operation(a.all()[a.count() == 1 ? 0 : i], b.all()[b.count() == 1 ? 0 : i]);
  return all;
}

double mean(const Values& values) {
  double sum = 0.0;
  for (const double value : values.all()) sum += value;
  return sum / static_cast<double>(values.count());
}

struct Builtin {
  const char* name;
  std::size_t arguments;
  Values (*compute)(const std::vector<Values>&);
};

const Builtin kBuiltins[] = {
    {"abs", 1,
     [](const auto& v) {
       return combined(v[0], 0.0, [](double a, double) { return std::abs(a); });
     }},
    {"sqrt", 1,
     [](const auto& v) {
       return combined(v[0], 0.0, [](double a, double) { return std::sqrt(a); });
     }},
    {"max", 2,
     [](const auto& v) {
       return combined(v[0], v[1], [](double a, double b) { return std::max(a, b); });
     }},
    {"mean", 1, [](const auto& v) { return Values(mean(v[0])); }},
    {"median", 1, [](const auto& v) { return Values(v[0].median()); }},
    {"lowest", 1, [](const auto& v) { return Values(v[0].lowest()); }},
    {"highest", 1, [](const auto& v) { return Values(v[0].highest()); }},
    {"distance", 2, [](const auto& v) {
       const double number = v[1].median(), below = v[0].lowest() - number;
       return Values(std::isfinite(below) ? std::max({0.0, below, number - v[0].highest()})
                                          : kNotPrinted);
     }}};

/// By recursive descent; `dry`: nothing is computed, every number is 1.
class Parser {
 public:
  Parser(const std::string& text, const Names& names, bool dry)
      : text_(text), names_(names), dry_(dry) {}

  Values whole() {
    Values value = sum();
    if (at_ < text_.size()) wrong("an operator");
    return value;
  }

 private:
  [[noreturn]] void wrong(const std::string& expected) const {
    throw InputError("'" + text_ + "': expected " + expected + " at '" + text_.substr(at_) + "'");
  }

  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    skip();
    return true;
  }

  Values sum() {
    Values value = product();
    for (;;) {
      if (take('+'))
        value = combined(value, product(), std::plus<>());
      else if (take('-'))
        value = combined(value, product(), std::minus<>());
      else
        return value;
    }
  }

  Values product() {
    Values value = factor();
    for (;;) {
      if (take('*'))
        value = combined(value, factor(), std::multiplies<>());
      else if (take('/'))
        value = combined(value, factor(), std::divides<>());
      else
        return value;
    }
  }

  Values factor() {
    if (take('-')) return combined(0.0, factor(), std::minus<>());
    if (take('(')) {
      Values value = sum();
      if (!take(')')) wrong(")");
      return value;
    }
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) return number();
    return called();
  }

  Values number() {
    std::size_t length = 0;
    const double value = std::stod(text_.substr(at_), &length);
    at_ += length;
    skip();
    return dry_ ? 1.0 : value;
  }

  std::string word() {
    const std::size_t from = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      ++at_;
    if (at_ == from) wrong("a number, a name or (");
    return text_.substr(from, at_ - from);
  }

  Values called() {
    const std::string name = word();
    if (!take('(')) {
      if (!names_) wrong("( after " + name);
      return names_(name);
    }
    for (const Builtin& builtin : kBuiltins)
      if (name == builtin.name) return ofBuiltin(builtin);
    const auto known = registry().find(name);
    if (known == registry().end()) wrong("a function that is known, not " + name + ",");
    const Words words = arguments();
    if (words.size() != known->second.arguments)
      wrong(std::to_string(known->second.arguments) + " arguments of " + name);
    return dry_ ? Values(1.0) : once(name, known->second, words);
  }

  Values ofBuiltin(const Builtin& builtin) {
    std::vector<Values> values{sum()};
    while (take(',')) values.push_back(sum());
    if (!take(')')) wrong(")");
    if (values.size() != builtin.arguments)
      wrong(std::to_string(builtin.arguments) + " arguments of " + builtin.name);
    return dry_ ? Values(1.0) : builtin.compute(values);
  }

  /// Words as they stand, up to the closing parenthesis.
  Words arguments() {
    const std::size_t end = text_.find(')', at_);
    if (end == std::string::npos) wrong(")");
    Words words;
    std::string now;
    for (; at_ < end; ++at_) {
      if (text_[at_] == ',') {
        words.push_back(now);
        now.clear();
      } else if (text_[at_] != ' ') {
        now += text_[at_];
      }
    }
    if (!now.empty() || !words.empty()) words.push_back(now);
    ++at_;
    skip();
    return words;
  }

  static Values once(const std::string& name, const Registered& computation, const Words& words) {
    static std::map<std::pair<std::string, Words>, Values> done;
    const auto key = std::make_pair(name, words);
    const auto known = done.find(key);
    if (known != done.end()) return known->second;
    return done.emplace(key, computation.compute(words)).first->second;
  }

  const std::string& text_;
  const Names& names_;
  bool dry_;
  std::size_t at_{0};
};

}  // namespace

bool registerComputation(const std::string& name, std::size_t arguments, Computation computation) {
  registry()[name] = {arguments, std::move(computation)};
  return true;
}

Values evaluate(const std::string& expression, const Names& names) {
  return Parser(expression, names, false).whole();
}

void requireSound(const std::string& expression, const std::vector<std::string>& names) {
  const Names known = [&](const std::string& name) -> Values {
    require(std::count(names.begin(), names.end(), name) > 0, "'" + expression + "'",
            "a name that is known, not " + name);
    return 1.0;
  };
  Parser(expression, known, true).whole();
}

}  // namespace fpc::papers
