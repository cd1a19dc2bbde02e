// fmbpc loops [WORDS]: which loop files there are, what they show, with which plant and controller.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <iostream>

#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/parallel.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/config/loop_file.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

struct Entry {
  std::string name, title, plant, controller;
};

Entry entryOf(const std::string& name) {
  try {
    const LoopFile loop = readLoop(name);
    const std::string plant = loop.external_plant ? "external" : loop.simulation.plant;
    return {name, loop.report.title, plant,
            loop.controllerType().name + (loop.has_clp ? " + clp" : "")};
  } catch (const std::exception& e) {
    return {name, std::string("cannot be read: ") + e.what(), "-", "-"};
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool containsAll(const Entry& entry, const std::vector<std::string>& words) {
  const std::string text =
      lower(entry.name + " " + entry.title + " " + entry.plant + " " + entry.controller);
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return text.find(lower(word)) != std::string::npos;
  });
}

std::vector<Entry> entries(const std::vector<std::string>& words) {
  const auto names = loopNames();
  std::vector<Entry> all(names.size());
  parallelFor(all.size(), 0, [&](std::size_t i) { all[i] = entryOf(names[i]); });
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Entry& entry) { return !containsAll(entry, words); }),
            all.end());
  return all;
}

}  // namespace

int loops(const std::vector<std::string>& words, bool names_only, bool json) {
  if (names_only) {  // read by the shell's completion: nothing but the folders is looked at
    for (const auto& name : loopNames()) std::cout << name << "\n";
    return 0;
  }
  const auto all = entries(words);
  Json list = Json::array();
  std::vector<std::vector<std::string>> table{{"loop", "plant", "controller", "title"}};
  for (const auto& entry : all) {
    list.push_back({{"name", entry.name},
                    {"title", entry.title},
                    {"plant", entry.plant},
                    {"controller", entry.controller}});
    table.push_back({entry.name, entry.plant, entry.controller, entry.title});
  }
  require(!all.empty(), join(words, " "),
          "words that a loop's name, title, plant or controller has");
  std::cout << (json ? Json{{"loops", list}}.dump(2) + "\n" : leftTable(table));
  return 0;
}

}  // namespace fpc::tool
