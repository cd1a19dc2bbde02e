#include "random/damage.hpp"

#include <sstream>

namespace fpc {
namespace {

const std::vector<std::string>& strangeValues() {
  static const std::vector<std::string> values{
      "-1",    "0",    "1e308", "-1e308", "1e-320",       ".nan",       ".inf",    "-.inf",
      "",      "[]",   "{}",    "~",      "010",          "0x10",       "1e9",     "2147483648",
      "true",  "text", "\"\"",  "*a",     "&a 1",         "4294967296", "[1, 2]",  "{a: 1}",
      "1 000", "1,5",  "-0",    "5e-324", "1.0000000001", "..",         "9999999", "!!int x",
      "'",     "@",    "%",     "- 1",    "[[[[[[[[[[[[", "{{{{{{{{",   "\t1",     "0.1e1e1"};
  return values;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Replaces what stands behind a colon, comma or bracket.
void spoilValue(std::string& line, Dice& dice) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] == ':' || line[i] == ',' || line[i] == '[') starts.push_back(i + 1);
  if (starts.empty()) return;
  const std::size_t from = dice.pick(starts);
  const std::size_t to = std::min(line.find_first_of(",]}", from), line.size());
  line = line.substr(0, from) + " " + dice.pick(strangeValues()) + line.substr(to);
}

void damageOnce(std::vector<std::string>& lines, Dice& dice) {
  if (lines.empty()) return;
  const auto at = [&] {
    return static_cast<std::size_t>(dice.whole(0, static_cast<int>(lines.size()) - 1));
  };
  const auto offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  const std::size_t i = at();
  std::string& line = lines[i];
  switch (dice.whole(0, 9)) {
    case 0:
      lines.erase(lines.begin() + offset(i));
      return;
    case 1:
      lines.insert(lines.begin() + offset(at()), std::string(line));
      return;
    case 2:
      line.insert(0, std::string(static_cast<std::size_t>(dice.whole(1, 4)), ' '));
      return;
    case 3:
      if (!line.empty())
        line.erase(static_cast<std::size_t>(dice.whole(0, static_cast<int>(line.size()) - 1)), 1);
      return;
    case 4:
      if (!line.empty())
        line[static_cast<std::size_t>(dice.whole(0, static_cast<int>(line.size()) - 1))] =
            static_cast<char>(dice.whole(1, 255));
      return;
    case 5:
      if (dice.chance(0.2)) lines.resize(i);
      return;
    default:
      spoilValue(line, dice);
  }
}

}  // namespace

std::string damaged(const std::string& text, Dice& dice) {
  auto lines = linesOf(text);
  for (int n = dice.whole(1, 3); n > 0; --n) damageOnce(lines, dice);
  return join(lines, "\n") + "\n";
}

}  // namespace fpc
