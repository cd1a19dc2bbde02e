#include "fmbpc/base/yaml_section.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/yaml_load.hpp"
#include "base/yaml_node.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::string describe(const Range& range) {
  const bool has_lower = range.lower > -kLargest;
  const bool has_upper = range.upper < kLargest;
  std::string words =
      range.lower == -kLargest || range.upper == kLargest ? "a finite number" : "a number";
  if (has_lower) words += (range.lower_open ? " > " : " >= ") + exactText(range.lower);
  if (has_upper) words += (has_lower ? " and <= " : " <= ") + exactText(range.upper);
  return words;
}

bool inside(double value, const Range& range) {
  if (std::isnan(value)) return false;
  if (std::isinf(value))
    return value > 0 ? range.upper == value : range.lower == value && !range.lower_open;
  return (range.lower_open ? value > range.lower : value >= range.lower) && value <= range.upper;
}

/// Digits only: 010 is eight to one reader of YAML and ten to the next, so it is no number here.
template <typename Integer>
std::optional<Integer> decimal(const std::string& text) {
  const std::size_t sign = text.find_first_of("+-") == 0 ? 1 : 0;
  if (text.size() > sign + 1 && text[sign] == '0') return std::nullopt;
  Integer value{};
  const char* first = text.data() + (text[0] == '+' ? 1 : 0);
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last || text.compare(0, 2, "+-") == 0) return std::nullopt;
  return value;
}

constexpr std::size_t kLongestList = 60;  // characters that a message repeats

/// What a file says where something else was expected.
std::string scalarText(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (!node.IsSequence()) return node.IsNull() ? "nothing" : "a mapping";
  std::string items;
  for (const auto& item : node) {
    const bool plain = item.IsScalar() || item.IsNull();
    if (!plain || items.size() > kLongestList) return "a list of " + std::to_string(node.size());
    items += (items.empty() ? "" : ", ") + (item.IsNull() ? "nothing" : item.Scalar());
  }
  return "[" + items + "]";
}

/// A key without a value is an empty mapping.
YAML::Node mappingOf(const YAML::Node& node) {
  return node.IsDefined() && !node.IsNull() ? node : YAML::Node(YAML::NodeType::Map);
}

}  // namespace

std::string YamlTrace::originOf(const std::string& path, const std::string& file) const {
  std::string known = path;
  while (true) {
    const auto origin = origins.find(known);
    if (origin != origins.end()) return origin->second;
    const auto cut = known.find_last_of(".[");
    if (cut == std::string::npos) return file + ": ";
    known.erase(cut);
  }
}

YamlSection YamlSection::load(const std::string& file) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  std::stringstream text;
  text << stream.rdbuf();
  return parse(text.str(), file);
}

YamlSection YamlSection::parse(const std::string& text, const std::string& name) {
  return {YamlNode(loadYaml(text, name)), name, ""};
}

YamlSection::YamlSection(const YamlNode& node, std::string file, std::string path,
                         std::shared_ptr<YamlTrace> trace)
    : node_(std::make_shared<const YamlNode>(mappingOf(node))),
      file_(std::move(file)),
      path_(std::move(path)),
      read_(std::make_shared<std::set<std::string>>()),
      trace_(std::move(trace)) {
  require(node_->IsMap(),
          (trace_ ? trace_->originOf(path_, file_) : file_ + ": ") +
              (path_.empty() ? "top level" : path_),
          "a mapping of keys to values");
  std::set<std::string> seen;
  for (const auto& entry : *node_)
    require(seen.insert(entry.first.Scalar()).second, where(entry.first.Scalar()),
            "the key only once");
}

std::string YamlSection::where(const std::string& key) const {
  const std::string path = pathOf(key);
  if (trace_) return trace_->originOf(path, file_) + path;
  const YAML::Node& map = *node_;
  const YAML::Node child = map[key.substr(0, key.find('.'))];
  const int line = child.IsDefined() ? child.Mark().line : map.Mark().line;
  return file_ + (line >= 0 ? ":" + std::to_string(line + 1) : "") + ": " + path;
}

void YamlSection::fail(const std::string& key, const std::string& expected) const {
  const YAML::Node& map = *node_;
  const YAML::Node child = map[key];
  throw InputError(where(key) + ": expected " + expected +
                   (child.IsDefined() ? ", got " + scalarText(child) : ""));
}

void YamlSection::markRead(const std::string& key) const {
  read_->insert(key);
  if (trace_) trace_->asked.insert(pathOf(key));
}

bool YamlSection::has(const std::string& key) const {
  const YAML::Node& map = *node_;
  return map[key].IsDefined();
}

YamlNode YamlSection::raw(const std::string& key) const {
  markRead(key);
  const YAML::Node& map = *node_;
  return map[key];
}

double YamlSection::toNumber(const YamlNode& node, const std::string& key,
                             const Range& range) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  const bool parsed = node.IsScalar() && YAML::convert<double>::decode(node, value);
  if (!parsed || !inside(value, range))
    throw InputError(where(key) + ": expected " + describe(range) + ", got " + scalarText(node));
  return value;
}

void YamlSection::number(const std::string& key, double& value, Range range) {
  const YAML::Node node = raw(key);
  if (node.IsDefined()) value = toNumber(node, key, range);
}

void YamlSection::integer(const std::string& key, int& value, int lower, int upper) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  const auto read = node.IsScalar() ? decimal<int>(node.Scalar()) : std::nullopt;
  if (!read || *read < lower || *read > upper)
    fail(key,
         "an integer >= " + std::to_string(lower) +
             (upper < std::numeric_limits<int>::max() ? " and <= " + std::to_string(upper) : ""));
  value = *read;
}

void YamlSection::seed(const std::string& key, std::uint64_t& value) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  const auto read = node.IsScalar() ? decimal<std::uint64_t>(node.Scalar()) : std::nullopt;
  if (!read) fail(key, "an integer >= 0");
  value = *read;
}

void YamlSection::boolean(const std::string& key, bool& value) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) fail(key, "true or false");
}

void YamlSection::text(const std::string& key, std::string& value) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) fail(key, "a text");
  value = node.Scalar();
}

void YamlSection::oneOf(const std::string& key, std::string& value,
                        const std::vector<std::string>& choices) {
  text(key, value);
  if (std::find(choices.begin(), choices.end(), value) == choices.end())
    fail(key, "one of " + join(choices));
}

void YamlSection::names(const std::string& key, std::vector<std::string>& value) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) fail(key, "a list of names");
  value.clear();
  for (const auto& item : node) {
    if (!item.IsScalar()) fail(key, "a list of names");
    value.push_back(item.Scalar());
  }
}

void YamlSection::subset(const std::string& key, std::vector<std::string>& value,
                         const std::vector<std::string>& known) {
  names(key, value);
  for (auto here = value.begin(); here != value.end(); ++here) {
    const bool exists = std::find(known.begin(), known.end(), *here) != known.end();
    const bool repeated = std::find(value.begin(), here, *here) != here;
    if (!exists || repeated)
      throw InputError(where(key) + ": expected names out of " + join(known) +
                       ", each once, got '" + *here + "'");
  }
}

void YamlSection::numbers(const std::string& key, std::vector<double>& value, Range range) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) fail(key, "a list of numbers");
  value.clear();
  for (const auto& item : node) value.push_back(toNumber(item, key, range));
}

bool YamlSection::interval(const std::string& key, double& lower, double& upper, Range range,
                           const std::string& what) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return false;
  const std::string expected = what + ", two numbers that do not decrease";
  if (!node.IsSequence() || node.size() != 2) fail(key, expected);
  const double first = toNumber(node[0], key, range), second = toNumber(node[1], key, range);
  if (!(first <= second)) fail(key, expected);
  lower = first;
  upper = second;
  return true;
}

std::vector<std::pair<double, double>> YamlSection::pairs(const std::string& key,
                                                          const std::string& what) {
  std::vector<std::pair<double, double>> all;
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return all;
  if (!node.IsSequence()) fail(key, what);
  for (const auto& item : node) {
    if (!item.IsSequence() || item.size() != 2) fail(key, what);
    all.emplace_back(toNumber(item[0], key, {}), toNumber(item[1], key, {}));
  }
  return all;
}

void YamlSection::vector(const std::string& key, Vector& value, Eigen::Index n, Range range) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (node.IsScalar()) {
    value = Vector::Constant(n, toNumber(node, key, range));
    return;
  }
  if (!node.IsSequence() || static_cast<Eigen::Index>(node.size()) != n)
    fail(key, "a list of " + std::to_string(n) + " numbers");
  value.resize(n);
  for (Eigen::Index i = 0; i < n; ++i)
    value[i] = toNumber(node[static_cast<std::size_t>(i)], key, range);
}

void YamlSection::byName(const std::string& key, Vector& value,
                         const std::vector<std::string>& names, Range range) {
  const YAML::Node node = raw(key);
  if (!node.IsDefined()) return;
  if (!node.IsMap()) return vector(key, value, static_cast<Eigen::Index>(names.size()), range);
  const auto n = static_cast<Eigen::Index>(names.size());
  const bool has_defaults = value.size() == n;
  Vector merged = has_defaults ? value : Vector::Zero(n);
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string name = entry.first.Scalar();
    const auto found = std::find(names.begin(), names.end(), name);
    const std::string path = key + "." + name;
    if (found == names.end()) throw InputError(where(path) + ": expected one of " + join(names));
    require(seen.insert(name).second, where(path), "the key only once");
    merged[found - names.begin()] = toNumber(entry.second, path, range);
  }
  for (const auto& name : names)
    if (!has_defaults && seen.count(name) == 0) fail(key, "a number for " + name);
  value = merged;
}

YamlSection YamlSection::section(const std::string& key) {
  const YAML::Node node = raw(key);
  return {mappingOf(node), file_, pathOf(key), trace_};
}

YamlSection YamlSection::sectionOrOff(const std::string& key, bool& off) {
  const YAML::Node node = raw(key);
  bool is = true;
  off = node.IsDefined() && node.IsScalar() && YAML::convert<bool>::decode(node, is) && !is;
  return {off ? YAML::Node(YAML::NodeType::Map) : mappingOf(node), file_, pathOf(key), trace_};
}

std::vector<YamlSection> YamlSection::list(const std::string& key) {
  const YAML::Node node = raw(key);
  std::vector<YamlSection> sections;
  if (!node.IsDefined()) return sections;
  if (!node.IsSequence()) fail(key, "a list of mappings");
  for (std::size_t i = 0; i < node.size(); ++i)
    sections.emplace_back(node[i], file_, pathOf(key) + "[" + std::to_string(i) + "]", trace_);
  return sections;
}

std::vector<std::string> YamlSection::keys() const {
  std::vector<std::string> all;
  for (const auto& entry : *node_) all.push_back(entry.first.Scalar());
  return all;
}

std::vector<std::string> YamlSection::unreadKeys() const {
  std::vector<std::string> unread;
  for (const auto& key : keys())
    if (read_->count(key) == 0) unread.push_back(key);
  return unread;
}

void YamlSection::finish() const {
  const auto unread = unreadKeys();
  if (unread.empty()) return;
  const std::vector<std::string> known(read_->begin(), read_->end());
  throw InputError(where(unread.front()) + ": unknown key; expected " +
                   (known.empty() ? "none here" : "one of " + join(known)));
}

}  // namespace fpc
