// fmbpc loops [WORDS]: which loop files there are, what they show, with which plant and controller.
#include <algorithm>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>

#include "base/near_names.hpp"
#include "base/ordered_json.hpp"
#include "base/parallel.hpp"
#include "config/loop_brief.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

struct Entry {
  std::string name, title, plant, controller;
  std::vector<std::string> needs;  ///< environment variables, to be run here
};

Entry readEntry(const std::string& name) {
  const LoopFile loop = readLoop(name);
  const std::string plant = loop.external_plant ? "external" : loop.simulation.plant;
  return {name,
          loop.report.title,
          plant,
          loop.controllerType().name + (loop.has_clp ? " + clp" : ""),
          {}};
}

/// Of a loop that cannot be read here: what its text says.
Entry unreadEntry(const std::string& name, const std::string& reason) {
  try {
    const LoopBrief brief = briefOf(name);
    const auto orDash = [](const std::string& text) { return text.empty() ? "-" : text; };
    const std::string lacks = brief.unset.empty() ? " (cannot be read: " + reason + ")" : "";
    return {name, brief.title + lacks, orDash(brief.plant),
            orDash(brief.controller) + (brief.has_clp ? " + clp" : ""), brief.unset};
  } catch (const std::exception&) {
    return {name, "cannot be read: " + reason, "-", "-", {}};
  }
}

Entry entryOf(const std::string& name) {
  try {
    return readEntry(name);
  } catch (const std::exception& e) {
    return unreadEntry(name, e.what());
  }
}

std::string titleOf(const Entry& entry) {
  return entry.title + (entry.needs.empty() ? "" : " (needs " + join(entry.needs) + ")");
}

bool containsAll(const Entry& entry, const std::vector<std::string>& words) {
  const std::string text =
      lowerCase(entry.name + " " + entry.title + " " + entry.plant + " " + entry.controller);
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return text.find(lowerCase(word)) != std::string::npos;
  });
}

/// The loops to begin with: names of first.txt in the first config folder that has one.
std::vector<std::string> firstNames() {
  std::vector<std::string> names;
  for (const std::string& folder : configFolders()) {
    std::ifstream file(folder + "/loop/first.txt");
    for (std::string line; std::getline(file, line);)
      if (!line.empty() && line[0] != '#') names.push_back(line);
    if (!names.empty()) break;
  }
  return names;
}

/// Those to begin with first, in their order; how many they are.
std::ptrdiff_t putFirst(std::vector<Entry>& entries) {
  auto end = entries.begin();
  for (const std::string& name : firstNames()) {
    const auto found =
        std::find_if(end, entries.end(), [&](const Entry& e) { return e.name == name; });
    if (found == entries.end()) continue;
    std::rotate(end, found, found + 1);
    ++end;
  }
  return end - entries.begin();
}

/// What may have been meant by the first word that no loop has.
std::string meantBy(const std::vector<std::string>& words, const std::vector<Entry>& all) {
  std::set<std::string> known;
  for (const Entry& e : all) known.insert({e.name, e.plant, e.controller});
  for (const auto& word : words) {
    const bool is_there = std::any_of(
        all.begin(), all.end(), [&](const Entry& entry) { return containsAll(entry, {word}); });
    if (!is_there) return nearNames(word, {known.begin(), known.end()}, kLoopsListsThem);
  }
  return std::string("; ") + kLoopsListsThem;
}

/// @throws InputError if there is none.
std::vector<Entry> entries(const std::vector<std::string>& words) {
  const auto names = loopNames();
  std::vector<Entry> all(names.size()), found;
  parallelFor(all.size(), 0, [&](std::size_t i) { all[i] = entryOf(names[i]); });
  std::copy_if(all.begin(), all.end(), std::back_inserter(found),
               [&](const Entry& entry) { return containsAll(entry, words); });
  require(!found.empty(), "loops " + join(words, " "),
          "words that a loop's name, title, plant or controller has" + meantBy(words, all));
  return found;
}

}  // namespace

int loops(const std::vector<std::string>& words, bool names_only, bool json) {
  if (names_only) {  // read by the shell's completion: nothing but the folders is looked at
    for (const auto& name : loopNames()) std::cout << name << "\n";
    return 0;
  }
  auto all = entries(words);
  const std::ptrdiff_t first = putFirst(all);
  Json list = Json::array();
  std::vector<std::vector<std::string>> table{{"loop", "plant", "controller", "title"}};
  if (first > 0) table.push_back({"to begin with:", "", "", ""});
  for (const auto& entry : all) {
    const bool begins = &entry - all.data() < first;
    if (first > 0 && &entry - all.data() == first) table.push_back({"further ones:", "", "", ""});
    list.push_back({{"name", entry.name},
                    {"title", entry.title},
                    {"plant", entry.plant},
                    {"controller", entry.controller},
                    {"first", begins},
                    {"needs", entry.needs}});
    table.push_back({entry.name, entry.plant, entry.controller, titleOf(entry)});
  }
  std::cout << (json ? Json{{"loops", list}}.dump(2) + "\n" : leftTable(table));
  return 0;
}

}  // namespace fpc::tool
