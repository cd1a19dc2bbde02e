// What a program maps that links the core: not the libraries that only the tool needs.
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/parallel.hpp"

namespace fpc::testing {
namespace base_mapped_libraries_test {

bool mapped(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != std::string::npos) return true;
  return false;
}

TEST(MappedLibraries, TheCoreBringsNoPagmo) {
  ASSERT_GE(coreCount(), 1);  // the core is linked
  EXPECT_TRUE(mapped("libfmbpc_core"));
  EXPECT_FALSE(mapped("libpagmo"));
}

}  // namespace base_mapped_libraries_test
}  // namespace fpc::testing
