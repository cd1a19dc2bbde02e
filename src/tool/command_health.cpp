// fmbpc health RECORD...: how loops are, and why.
#include <filesystem>
#include <iostream>

#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "tool/commands.hpp"
#include "tool/health_page.hpp"
#include "tool/health_records.hpp"

namespace fpc::tool {

int health(const HealthArguments& a) {
  std::vector<std::string> remarks;
  const std::vector<NamedRecord> records = healthRecords(a, remarks);
  std::vector<LoopHealth> loops;
  for (const NamedRecord& named : records) loops.push_back(judgeLoop(named.record));
  relateLoops(loops);
  if (!a.out.empty()) writeHealth(records, loops, a.out);
  if (a.json) {
    OrderedJson json = OrderedJson::object();
    for (std::size_t i = 0; i < loops.size(); ++i)
      json["loops"].push_back(toJson(loops[i], records[i].name));
    json["remarks"] = remarks;
    std::cout << json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) << "\n";
    return 0;
  }
  std::cout << healthTable(records, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    std::cout << "\n"
              << records[i].name << ": " << nameOf(loops[i].cause) << ". "
              << adviceOf(loops[i].cause) << ".\n";
    for (const std::string& remark : loops[i].remarks) std::cout << "  " << remark << ".\n";
  }
  for (const std::string& remark : remarks) std::cout << "remark: " << remark << "\n";
  if (!a.out.empty())
    std::cout << "written: " << (std::filesystem::path(a.out) / "index.html").string() << "\n";
  return 0;
}

}  // namespace fpc::tool
