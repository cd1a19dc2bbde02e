// fmbpc check PACKAGE: what every plant and controller promises, asked of those of a package.
#include <algorithm>
#include <iostream>

#include "config/loop_brief.hpp"
#include "config/plugins.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/contract.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Names = std::vector<std::string>;

Names added(const Names& before, const Names& after) {
  Names fresh;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::back_inserter(fresh));
  return fresh;
}

/// Prints them; how many are broken.
int print(const std::string& subject, const std::vector<Promise>& promises) {
  int broken = 0;
  std::cout << subject << "\n";
  for (const Promise& p : promises) {
    broken += p.broken.empty() ? 0 : 1;
    std::cout << "  " << (p.broken.empty() ? "kept    " : "BROKEN  ") << p.name
              << (p.broken.empty() ? "" : ": " + p.broken) << "\n";
  }
  return broken;
}

/// The first loop of this type that can be simulated; empty if there is none.
std::string loopOf(const std::string& type) {
  for (const std::string& file : loopFiles()) {
    try {
      const LoopBrief brief = briefOf(file);
      if (brief.controller == type && brief.plant != "external") return file;
    } catch (const InputError&) {
      continue;  // another loop's mistake
    }
  }
  return "";
}

}  // namespace

int check(const std::string& package) {
  const Names plants_before = plantNames(), controllers_before = controllerNames();
  loadPlugin(package, "PACKAGE");
  const Names plants = added(plants_before, plantNames()),
              controllers = added(controllers_before, controllerNames());
  int broken = 0;
  for (const std::string& plant : plants)
    broken += print("plant " + plant, plantPromises(*makePlant(plant), plant));
  for (const std::string& type : controllers) {
    const std::string loop = loopOf(type);
    require(
        !loop.empty(), "controller " + type,
        "a loop file with this controller.type in a config folder (FMBPC_CONFIG_PATH) to try it "
        "on");
    broken += print("controller " + type + ", on " + loop, controllerPromises(readLoop(loop)));
  }
  require(!plants.empty() || !controllers.empty(), package,
          "a package with plants or controllers that fmbpc has not loaded yet");
  if (broken == 0) return 0;
  std::cerr << "fmbpc: " << broken << (broken == 1 ? " promise is" : " promises are")
            << " broken\n";
  return 1;
}

}  // namespace fpc::tool
