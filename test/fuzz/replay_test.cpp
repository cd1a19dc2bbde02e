// Every file of the committed corpora through its target: what a fuzzer once found stays found.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fuzz/targets.hpp"
#include "paths.hpp"

namespace fpc::fuzz {
namespace {

class Replay : public ::testing::TestWithParam<NamedTarget> {};

TEST_P(Replay, HoldsWhatItPromises) {
  int files = 0;
  const std::string corpus = sourceDir() + "/test/fuzz/corpus/";
  for (const auto& entry : std::filesystem::directory_iterator(corpus + GetParam().name)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_NO_THROW(GetParam().run(bytes)) << entry.path();
    EXPECT_LE(bytes.size(), 4096U) << entry.path() << ": corpora stay small";
    ++files;
  }
  EXPECT_GE(files, 3);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace fpc::fuzz
