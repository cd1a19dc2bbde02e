// docs/structure_file.md lists every key the structure reader knows and no other, with the defaults
// of the structs.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "paths.hpp"

namespace fpc {
namespace config_structure_doc_test {

/// Default by key, from rows "| `key` | default | meaning |"; a cell may name several keys of one
/// section.
std::map<std::string, std::string> documented() {
  std::ifstream stream(sourceDir() + "/docs/structure_file.md");
  std::map<std::string, std::string> rows;
  const std::regex row(R"(\| (`[^|]+`) \| ([^|]*) \| ([^|]+) \|)"), key(R"(`([^`]+)`)");
  std::string section;
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    const std::string keys = match[1], fallback = match[2];
    std::vector<std::string> fallbacks;
    std::stringstream parts(fallback);
    for (std::string part; std::getline(parts, part, ',');)
      fallbacks.push_back(part.substr(part.find_first_not_of(' ') == 0 ? 0 : 1));
    std::size_t n = 0;
    const auto count = std::distance(std::sregex_iterator(keys.begin(), keys.end(), key), {});
    for (std::sregex_iterator k(keys.begin(), keys.end(), key), end; k != end; ++k, ++n) {
      std::string name = (*k)[1];
      if (name.front() == '.')
        name = section + name;
      else
        section =
            name.substr(0, name.rfind('.') == std::string::npos ? name.size() : name.rfind('.'));
      EXPECT_EQ(rows.count(name), 0U) << name;
      const bool each = static_cast<std::size_t>(count) == fallbacks.size();
      rows[name] = each ? fallbacks[n] : fallback;
    }
  }
  return rows;
}

const std::string kBase =
    "name: n\nsample_time_s: 1\noutputs: {y: {}}\ninputs: {u: {}}\nsubmodels:\n  y: {N_y: [1], "
    "N_u: [1]}\n";

std::string errorOf(const std::string& text) {
  try {
    parseStructure(text, "doc.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(StructureDocs, EveryDocumentedSettingIsAKeyOfTheReader) {
  const auto rows = documented();
  ASSERT_GT(rows.size(), 30U);
  std::size_t tried = 0;
  for (const auto& [key, fallback] : rows) {
    const auto dot = key.find('.');
    const std::string section = key.substr(0, dot);
    if (dot == std::string::npos || fallback.empty() ||
        std::set<std::string>{"partition", "consequents", "repair", "validation", "csv"}.count(
            section) == 0)
      continue;
    const std::string text = section + ": {" + key.substr(dot + 1) + ": " + fallback + "}\n";
    EXPECT_EQ(errorOf(kBase + text), "") << text;
    ++tried;
  }
  EXPECT_EQ(tried, 30U);
}

/// The keys that the reader names when it meets one that it does not know.
std::set<std::string> known(const std::string& section) {
  const std::string error = errorOf(kBase + section + ": {nonsense: 1}\n");
  std::set<std::string> keys;
  const std::regex word(R"([A-Za-z_]+)");
  const std::string list = error.substr(error.find("one of ") + 7);
  for (std::sregex_iterator w(list.begin(), list.end(), word), end; w != end; ++w)
    keys.insert((*w).str());
  return keys;
}

TEST(StructureDocs, EverySettingOfTheReaderIsDocumented) {
  const auto rows = documented();
  for (const char* section : {"partition", "consequents", "repair", "validation", "csv"}) {
    const auto keys = known(section);
    EXPECT_GE(keys.size(), 2U) << section;
    for (const auto& key : keys) {
      const std::string path = std::string(section) + "." + key;
      EXPECT_EQ(rows.count(path), 1U) << path;
    }
  }
}

/// The words of a list "gaussian, exponential or multivariate".
std::set<std::string> words(const std::string& text) {
  std::set<std::string> found;
  const std::regex word(R"([a-z_]+)");
  for (std::sregex_iterator w(text.begin(), text.end(), word), end; w != end; ++w)
    found.insert((*w).str());
  return found;
}

TEST(StructureDocs, EveryMembershipOfTheReaderIsDocumented) {
  std::ifstream stream(sourceDir() + "/docs/structure_file.md");
  std::string row;
  while (std::getline(stream, row) && row.rfind("| `.membership` |", 0) != 0) {
  }
  const std::set<std::string> told = words(row);
  const std::string error = errorOf(kBase + "partition: {membership: nonsense}\n");
  for (const char* shape : {"gaussian", "exponential", "multivariate"}) {
    EXPECT_EQ(told.count(shape), 1U) << row;
    EXPECT_NE(error.find(shape), std::string::npos) << error;
    EXPECT_EQ(errorOf(kBase + "partition: {membership: " + shape + "}\n"), "");
  }
}

TEST(StructureDocs, DefaultsAreThoseOfTheStructs) {
  const auto rows = documented();
  const PartitionParams p;
  const ConsequentParams c;
  const ValidationParams v;
  const std::map<std::string, double> defaults{
      {"partition.fuzziness", p.fuzziness},
      {"partition.regularisation", p.regularisation},
      {"partition.width", p.width},
      {"partition.max_iterations", p.max_iterations},
      {"partition.tolerance", p.tolerance},
      {"partition.restarts", p.restarts},
      {"partition.seed", static_cast<double>(p.seed)},
      {"partition.held_out", p.held_out},
      {"consequents.ridge", c.ridge},
      {"consequents.samples_per_coefficient", c.samples_per_coefficient},
      {"consequents.max_condition", c.max_condition},
      {"consequents.forgetting", c.forgetting},
      {"consequents.free_run_iterations", c.free_run_iterations},
      {"consequents.one_step_weight", c.one_step_weight},
      {"validation.correlation_lags", v.correlation_lags},
      {"validation.confidence", v.confidence}};
  for (const auto& [key, value] : defaults) {
    ASSERT_EQ(rows.count(key), 1U) << key;
    EXPECT_EQ(std::stod(rows.at(key)), value) << key;
  }
}

}  // namespace config_structure_doc_test
}  // namespace fpc
