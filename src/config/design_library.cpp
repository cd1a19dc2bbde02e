#include "config/design_library.hpp"

#include <dlfcn.h>

#include "config/plugins.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Fill = void(DesignLibrary&);

DesignLibrary loadedFor(const std::string& what) {
  void* library = dlopen((libraryFolder() + "/libfmbpc_design_core.so").c_str(), RTLD_NOW);
  require(library != nullptr, what,
          "the library fmbpc_design_core: `scripts/build` makes it (" +
              std::string(library ? "" : dlerror()) + ")");
  DesignLibrary found{};
  reinterpret_cast<Fill*>(dlsym(library, "fmbpcDesignLibrary"))(found);
  return found;
}

}  // namespace

const DesignLibrary& designLibrary(const std::string& what) {
  static const DesignLibrary library = loadedFor(what);
  return library;
}

}  // namespace fpc
