// `fmbpc replay BAG`: a recorded run once more, actions compared bit for bit.
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "base/ordered_json.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/bag_reader.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

LoopFile loopOf(const ReplayArguments& a) {
  const Overrides overrides = parseOverrides(a.set);
  if (!a.loop.empty()) return readLoop(a.loop, overrides);
  require(a.set.empty(), "--set", "a LOOP: the bag's own loop is taken as it is");
  return parseLoop(loopTextOf(a.bag), std::filesystem::path(a.bag).stem().string());
}

Json jsonOf(const ReplayedActions& actions) {
  return {{"compared", actions.compared},
          {"equal", actions.equal},
          {"first_difference", actions.first_difference}};
}

Json jsonOf(const ReplayArguments& a, const ReplayResult& result) {
  return {{"bag", a.bag},
          {"measurements", result.measurements},
          {"missing", result.missing},
          {"missing_samples", result.missing_samples},
          {"ended", result.ended},
          {"base_action", jsonOf(result.base)},
          {"control_action", jsonOf(result.control)},
          {"stood_in", result.stood_in},
          {"refused", result.refused},
          {"equal", result.equal()}};
}

void print(const char* topic, const ReplayedActions& actions) {
  if (actions.compared == 0) return;
  std::printf("%-15s %7u compared, %7u equal bit for bit\n", topic, actions.compared,
              actions.equal);
  if (!actions.first_difference.empty())
    std::printf("%-15s first difference: %s\n", "", actions.first_difference.c_str());
}

void print(const ReplayResult& result) {
  for (const std::string& words : result.missing) std::printf("missing: %s\n", words.c_str());
  if (result.missing_samples > 0)
    std::printf("%-15s %7u samples are not whole in the bag\n", "", result.missing_samples);
  if (!result.ended) std::printf("the bag ends before the final sample of its run\n");
  std::printf("%-15s %7u played\n", "measurement", result.measurements);
  print("base_action", result.base);
  print("control_action", result.control);
  if (result.stood_in > 0)
    std::printf("%-15s %7u samples at which the controller stood in for its optimizer\n", "",
                result.stood_in);
  for (const std::string& words : result.refused) std::printf("refused: %s\n", words.c_str());
}

}  // namespace

int replay(const ReplayArguments& arguments) {
  require(std::filesystem::is_regular_file(arguments.bag), arguments.bag, "an existing bag");
  const LoopFile loop = loopOf(arguments);
  const ReplayResult result = replay(loop, readBagRun(arguments.bag, loop, arguments.run));
  if (arguments.json)
    std::cout << jsonOf(arguments, result).dump(2) << "\n";
  else
    print(result);
  return result.equal() ? 0 : 1;
}

}  // namespace fpc::tool
