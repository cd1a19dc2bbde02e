// Overrides as a person types them, one or many in a line.
#include <cctype>

#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// Where the word at `from` ends: at a space outside brackets and quotes.
std::size_t endOfWord(const std::string& text, std::size_t from) {
  int depth = 0;
  char quote = '\0';
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
      continue;
    }
    const bool begins_quote = i == from || !std::isalnum(static_cast<unsigned char>(text[i - 1]));
    if ((c == '\'' || c == '"') && begins_quote) quote = c;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth <= 0 && std::isspace(static_cast<unsigned char>(c))) return i;
  }
  return text.size();
}

/// "path=..." with a path of letters, digits, dots, slashes and underscores.
bool beginsOverride(const std::string& word) {
  const auto equals = word.find('=');
  if (equals == 0 || equals == std::string::npos) return false;
  for (std::size_t i = 0; i < equals; ++i)
    if (!std::isalnum(static_cast<unsigned char>(word[i])) && word[i] != '.' && word[i] != '_' &&
        word[i] != '/')
      return false;
  return true;
}

/// What stands in quotes around a whole override, as a shell would take it; empty for other words.
std::string insideQuotes(const std::string& word) {
  const bool quoted = word.size() > 2 && (word.front() == '\'' || word.front() == '"') &&
                      word.find(word.front(), 1) == word.size() - 1;
  const std::string inside = quoted ? word.substr(1, word.size() - 2) : "";
  return beginsOverride(inside) ? inside : "";
}

}  // namespace

Overrides parseOverrides(const std::vector<std::string>& texts) {
  Overrides overrides;
  for (const auto& text : texts) overrides.push_back(parseOverride(text));
  return overrides;
}

Overrides parseOverrides(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();) {
    if (std::isspace(static_cast<unsigned char>(text[at]))) {
      ++at;
      continue;
    }
    const std::size_t end = endOfWord(text, at);
    std::string word = text.substr(at, end - at);
    const std::string inside = insideQuotes(word);
    if (!inside.empty()) word = inside;
    if (beginsOverride(word) || parts.empty())
      parts.push_back(word);
    else
      parts.back() += " " + word;
    at = end;
  }
  Overrides overrides;
  for (const std::string& part : parts) overrides.push_back(parseOverride(part));
  return overrides;
}

}  // namespace fpc
