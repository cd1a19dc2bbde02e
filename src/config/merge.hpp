// Loop files merged over the files they extend, with the origin of every key. Private to the room.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <memory>
#include <string>

#include "base/yaml_node.hpp"
#include "config/loop_file.hpp"

namespace fpc {

/// Who set a key: a line of a file, or (with an empty file) the command line.
struct Origin {
  std::string file;
  int line{};
};

/// Symbols: paths as in errors, "controller.loops[0].kp".
struct MergedLoop {
  YAML::Node root;
  std::map<std::string, Origin> origins;

  std::string whereIs(const std::string& path) const;  ///< "file:12: path" or "--set path"
  std::shared_ptr<YamlTrace> trace() const;
};

/// Reads a file and everything it extends. Mappings merge, lists and scalars replace; a section
/// whose `type` changes is replaced as a whole, because its other keys belong to the old type.
/// @throws InputError naming file, line and key: bad YAML, repeated keys, missing or circular
/// `extends`, a key without a value over a mapping with keys.
MergedLoop mergeLoop(const std::string& file);
/// Writes overrides over it, in order. @throws InputError naming "--set path": also nothing over a
/// mapping with keys.
void applyOverrides(MergedLoop& loop, const Overrides& overrides);

}  // namespace fpc
