#include "config/variation.hpp"

#include <cmath>
#include <cstdlib>
#include <set>

#include "base/split.hpp"
#include "base/yaml_node.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr std::size_t kMostSeeds = 100000;

std::uint64_t wholeNumber(const std::string& text, const std::string& where) {
  const bool digits = !text.empty() && text.size() < 19 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  require(digits, where, "whole numbers >= 0 as in 1:40 or 1,2,7; got '" + text + "'");
  return std::stoull(text);
}

}  // namespace

double plainNumber(const std::string& text, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  require(!text.empty() && *end == '\0' && std::isfinite(value), where,
          "a number; got '" + text + "'");
  return value;
}

std::vector<std::uint64_t> parseSeeds(const std::string& text, const std::string& where) {
  std::vector<std::uint64_t> seeds;
  for (const auto& part : split(text, ',')) {
    const auto ends = split(part, ':');
    require(ends.size() == 1 || ends.size() == 2, where, "seeds as in 1:40 or 1,2,7");
    const std::uint64_t first = wholeNumber(ends.front(), where);
    const std::uint64_t last = wholeNumber(ends.back(), where);
    require(first <= last && last - first < kMostSeeds, where,
            "FIRST:LAST that do not decrease, at most " + std::to_string(kMostSeeds));
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  const std::set<std::uint64_t> once(seeds.begin(), seeds.end());
  require(!seeds.empty() && once.size() == seeds.size(), where,
          "at least one seed, each only once");
  return seeds;
}

Variation parseVariation(const std::string& text) {
  const auto at = text.find('=');
  const std::string expected =
      "KEY=LOWER:UPPER (factors) or KEY=value:LOWER:UPPER; got '" + text + "'";
  require(at != std::string::npos && at > 0, "--vary", expected);
  auto parts = split(text.substr(at + 1), ':');
  Variation variation;
  variation.key = text.substr(0, at);
  variation.factor = parts.empty() || parts.front() != "value";
  if (!variation.factor) parts.erase(parts.begin());
  require(parts.size() == 2, "--vary", expected);
  variation.lower = plainNumber(parts[0], "--vary " + variation.key);
  variation.upper = plainNumber(parts[1], "--vary " + variation.key);
  return variation;
}

void checkVariations(const std::vector<Variation>& vary) {
  std::set<std::string> keys;
  for (const auto& v : vary) {
    require(keys.insert(v.key).second, "vary", "every key only once, got " + v.key + " twice");
    require(v.lower < v.upper, "vary",
            "lower < upper of " + v.key + " (a number that does not vary stands under set), got " +
                exactText(v.lower) + " and " + exactText(v.upper));
  }
}

std::vector<std::uint64_t> readSeeds(YamlSection& section) {
  const YAML::Node node = section.raw("seeds");
  if (!node.IsDefined()) return {};
  std::string text;
  if (node.IsScalar()) text = node.Scalar();
  for (std::size_t i = 0; node.IsSequence() && i < node.size(); ++i)
    text += (i ? "," : "") + node[i].as<std::string>();
  return parseSeeds(text, section.where("seeds"));
}

std::vector<Variation> readVariations(YamlSection& section) {
  std::vector<Variation> all;
  const YAML::Node node = section.raw("vary");
  if (node.IsDefined() && !node.IsMap())
    section.fail("vary", "a mapping of key.path: [lower, upper]");
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    Variation variation;
    variation.key = key;
    YAML::Node range = entry.second;
    if (range.IsMap()) {
      variation.factor = false;
      range = range["values"];
    }
    if (!range.IsDefined() || !range.IsSequence() || range.size() != 2)
      section.fail("vary", key + ": [lower, upper] as factors, or {values: [lower, upper]}");
    variation.lower = plainNumber(range[0].as<std::string>(), section.where("vary"));
    variation.upper = plainNumber(range[1].as<std::string>(), section.where("vary"));
    all.push_back(variation);
  }
  return all;
}

}  // namespace fpc
