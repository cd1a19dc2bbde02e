// A loop file that changes a few keys of another.
#pragma once

#include <string>

#include "config/loop_file.hpp"

namespace fpc {

/// YAML text: `comment` (lines without #), `extends: LOOP`, a title and the overrides. Lists that
/// an override changes are written out whole, because lists do not merge.
/// @throws InputError as resolveLoop().
std::string extendingLoop(const std::string& name_or_path, const Overrides& overrides,
                          const std::string& title, const std::string& comment);

/// The scalar at a path as --set takes it, as text; empty if there is none.
std::string scalarOf(const std::string& resolved, const std::string& path);

}  // namespace fpc
