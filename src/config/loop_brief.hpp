// What a list shows of a loop, also of one whose data files are not there.
#pragma once

#include <string>
#include <vector>

namespace fpc {

struct LoopBrief {
  std::string title;               ///< the loop's name if it has none
  std::string plant, controller;   ///< their types; empty: none is named
  bool has_clp{};                  ///< a section clp that is not switched off
  std::vector<std::string> unset;  ///< environment variables that it names and that are not set
};

/// From the file merged over what it extends: nothing is read into structs, no other file opened.
/// @throws InputError as resolveLoop() for files that cannot be merged.
LoopBrief briefOf(const std::string& name_or_path);

}  // namespace fpc
