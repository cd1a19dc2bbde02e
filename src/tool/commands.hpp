// The commands of the tool `fmbpc`, one file each. Every one returns the exit code and throws
// InputError.
#pragma once

#include <string>
#include <vector>

namespace fpc::tool {

struct RunArguments {
  std::vector<std::string> loops;
  std::vector<std::string> set;  ///< "path=value"
  std::string out;               ///< folder, empty: nothing is written
  bool json{false};
  bool no_plot{false};
};

struct IdentifyArguments {
  std::string data;           ///< CSV or bag
  std::string structure;      ///< name of config/structure, or path
  std::string rows;           ///< "FIRST:LAST", empty: all
  std::string validate;       ///< another record, empty: the same
  std::string validate_rows;  ///< of it; both empty: nothing is held out
  std::string out;            ///< model file, empty: none
  std::string plots;          ///< folder, empty: none
  bool json{false};
};

int identify(const IdentifyArguments& arguments);
int run(const RunArguments& arguments);
int resolve(const std::string& loop, const std::vector<std::string>& set);
int plants(bool json);
int model(const std::string& file, bool json);
int table(const std::vector<std::string>& folders);

}  // namespace fpc::tool
