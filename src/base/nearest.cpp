#include "fmbpc/base/nearest.hpp"

#include <algorithm>
#include <utility>

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
  for (const auto& candidate : known) {
    const std::size_t edits = editsBetween(word, candidate);
    const bool begins = word.size() >= 3 && candidate.rfind(word, 0) == 0;
    if (begins || edits <= std::max<std::size_t>(word.size() / 3, 1))
      ranked.emplace_back(begins ? 1 : edits, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(limit, ranked.size()); ++i) words.push_back(ranked[i].second);
  return words;
}

}  // namespace fpc
