#include "fmbpc/base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) all += (i == 0 ? "" : separator) + words[i];
  return all;
}

std::string exactText(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string expandEnvironment(const std::string& text, const std::string& where) {
  std::string expanded;
  std::size_t from = 0;
  for (auto open = text.find("${"); open != std::string::npos; open = text.find("${", from)) {
    const auto close = text.find('}', open);
    require(close != std::string::npos, where, "a closing brace after '${'");
    const std::string name = text.substr(open + 2, close - open - 2);
    const char* value = std::getenv(name.c_str());
    require(value != nullptr, where, "the environment variable " + name + " to be set");
    expanded += text.substr(from, open - from) + value;
    from = close + 1;
  }
  return expanded + text.substr(from);
}

}  // namespace fpc
