#include "fmbpc/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/near_names.hpp"
#include "base/number.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// Letters to leave out, add, change or swap with their neighbour (optimal string alignment).
std::size_t editsBetween(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& known,
                                 std::size_t limit) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  if (word.empty()) return {};
  const std::string meant = lowerCase(word);
  for (const auto& candidate : known) {
    const std::string name = lowerCase(candidate);
    const std::size_t edits = editsBetween(meant, name), at = name.find(meant);
    const bool slip = edits <= std::max<std::size_t>(meant.size() / 3, 1);
    const bool part = meant.size() >= 3 && at != std::string::npos;
    const std::size_t as_part = at == 0 ? 1 : 2;
    if (slip || part)
      ranked.emplace_back(slip && part ? std::min(edits, as_part)
                          : part       ? as_part
                                       : edits,
                          candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(limit, ranked.size()); ++i)
    words.push_back(ranked[i].second);
  return words;
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) all += (i == 0 ? "" : separator) + words[i];
  return all;
}

std::string exactText(double value) {
  if (std::isnan(value)) return "nan";
  return printNumber(value);
}

std::optional<double> numberOf(const std::string& text) {
  const std::size_t plus = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
  const auto value = parseNumber(std::string_view(text).substr(plus));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string shortText(double value) {
  if (std::isnan(value)) return "-";
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value == 0.0 ? 0.0 : value);  // no -0
  return buffer.data();
}

namespace {

std::vector<std::size_t> widthsOf(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  return widths;
}

}  // namespace

std::string alignedTable(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<std::size_t> widths = widthsOf(rows);
  std::string text;
  for (const auto& row : rows) {
    std::string line = row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i)
      line += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    text += line + "\n";
  }
  return text;
}

std::string leftTable(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<std::size_t> widths = widthsOf(rows);
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + (i + 1 < row.size() ? std::string(widths[i] + 2 - row[i].size(), ' ') : "");
    text += line + "\n";
  }
  return text;
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
