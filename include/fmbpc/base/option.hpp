// Options that are one of a few words: an enum class in the code, a word in files, both tied in one
// place.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

/// Beside its enumerators, which count from 0, an option has its words in the same order:
///   enum class Pace { kLockstep, kPaced };
///   inline std::vector<std::string> wordsOf(Pace) { return {"lockstep", "paced"}; }
template <typename Option>
std::string wordOf(Option option) {
  return wordsOf(option)[static_cast<std::size_t>(option)];
}

/// Reads the word at `key`; an absent key leaves `option` alone. @throws InputError with the words.
template <typename Option>
void readOption(YamlSection& section, const std::string& key, Option& option) {
  const std::vector<std::string> words = wordsOf(option);
  std::string word = words[static_cast<std::size_t>(option)];
  section.oneOf(key, word, words);
  for (std::size_t i = 0; i < words.size(); ++i)
    if (word == words[i]) option = static_cast<Option>(i);
}

/// The same with the words at hand, for an option of which only some values are allowed here, or
/// which is kept as a bool or as an optional:
///   readOption(section, "table", tag.input_table, {{"holding", false}, {"input", true}});
template <typename Option>
void readOption(YamlSection& section, const std::string& key, Option& option,
                const std::vector<std::pair<std::string, Option>>& choices) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  std::string word = words.front();
  section.oneOf(key, word, words);
  if (!section.has(key)) return;
  for (const auto& choice : choices)
    if (word == choice.first) option = choice.second;
}

}  // namespace fpc
