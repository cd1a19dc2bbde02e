// A YAML mapping in which typos cannot hide: every key is read once, over a default, and what is
// left is an error. What a reader of a section needs, also one of another package.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct YamlNode;  ///< of yaml-cpp, which no public header shows

/// Closed range of a number; open ends by excluding the bound. Infinite numbers pass only when a
/// bound is infinite.
struct Range {
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
  bool lower_open{false};
  static Range positive() {
    return {0.0, std::numeric_limits<double>::max(), true};
  }  ///< and finite
  static Range notNegative() {
    return {0.0, std::numeric_limits<double>::max(), false};
  }  ///< and finite
};

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr Range kFinite{-kLargest, kLargest};
constexpr Range kFinitePositive{0.0, kLargest, true};
constexpr Range kFiniteNotNegative{0.0, kLargest};

/// For a text merged from several files: where each path ("controller.loops[0].kp") was written,
/// and which paths a reader asked for. Shared by all sections of the text.
struct YamlTrace {
  std::map<std::string, std::string>
      origins;  ///< path -> what stands before it in errors: "file:12: ", "--set "
  std::set<std::string> asked;
  /// Origin of the path, or of the nearest part of it that is known.
  std::string originOf(const std::string& path, const std::string& file) const;
};

/// One mapping of a YAML file. All readers leave `value` alone when the key is absent.
class YamlSection {
 public:
  static YamlSection load(const std::string& file);
  static YamlSection parse(const std::string& text, const std::string& name);
  /// @throws InputError unless the node is a mapping (a null node is an empty one).
  YamlSection(const YamlNode& node, std::string file, std::string path,
              std::shared_ptr<YamlTrace> trace = nullptr);

  bool has(const std::string& key) const;
  void number(const std::string& key, double& value, Range range = {});
  void integer(const std::string& key, int& value, int lower,
               int upper = std::numeric_limits<int>::max());
  void seed(const std::string& key, std::uint64_t& value);
  void boolean(const std::string& key, bool& value);
  void text(const std::string& key, std::string& value);
  void oneOf(const std::string& key, std::string& value, const std::vector<std::string>& choices);
  void names(const std::string& key, std::vector<std::string>& value);
  /// Names out of `known`, each once.
  void subset(const std::string& key, std::vector<std::string>& value,
              const std::vector<std::string>& known);
  void numbers(const std::string& key, std::vector<double>& value, Range range = {});
  /// Two numbers that do not decrease; without the key both stay, and it returns false. `what` they
  /// are stands in the error.
  bool interval(const std::string& key, double& lower, double& upper, Range range = {},
                const std::string& what = "[lower, upper]");
  /// A list of [x, y], none: empty; `what` they are stands in the error.
  std::vector<std::pair<double, double>> pairs(const std::string& key, const std::string& what);
  /// n numbers; also accepts one number for all n. `.inf` and `-.inf` pass when the range allows
  /// them.
  void vector(const std::string& key, Vector& value, Eigen::Index n, Range range = {});
  /// A mapping name -> number over `names`: values of absent names stay; if `value` has another
  /// size than `names`, no name may be absent. Also accepts a list of names.size() numbers.
  void byName(const std::string& key, Vector& value, const std::vector<std::string>& names,
              Range range = {});
  YamlSection section(const std::string& key);  ///< an absent key is an empty section
  /// The same where `KEY: false` takes the section out: it is empty then, and `off` is true.
  YamlSection sectionOrOff(const std::string& key, bool& off);
  std::vector<YamlSection> list(const std::string& key);  ///< a list of mappings
  std::vector<std::string> unreadKeys() const;
  std::vector<std::string> keys() const;
  void markRead(const std::string& key) const;
  /// @throws InputError naming the first key that nobody read, with what this section knows.
  void finish() const;
  /// "file:line: path.key"
  std::string where(const std::string& key) const;
  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;
  YamlNode raw(const std::string& key) const;  ///< marks the key as read; src/base/yaml_node.hpp
  const std::string& file() const { return file_; }

 private:
  std::string pathOf(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
  }
  double toNumber(const YamlNode& node, const std::string& key, const Range& range) const;

  std::shared_ptr<const YamlNode> node_;
  std::string file_, path_;
  std::shared_ptr<std::set<std::string>> read_;
  std::shared_ptr<YamlTrace> trace_;  // may be null
};

/// A required key: fails unless it is there.
void need(const YamlSection& section, const std::string& key, const std::string& expected);
/// Index of the name that stands at `key`. @throws InputError listing the names.
int indexByName(YamlSection& section, const std::string& key,
                const std::vector<std::string>& names);
/// Throws `message` ("field: expected ...") again with the place of the field in the file.
[[noreturn]] void failAt(const YamlSection& section, const std::string& message);

/// Runs a check whose InputError knows the field but not the file.
template <typename Check>
void checked(const YamlSection& section, Check check) {
  try {
    check();
  } catch (const InputError& e) {
    failAt(section, e.what());
  }
}

}  // namespace fpc
