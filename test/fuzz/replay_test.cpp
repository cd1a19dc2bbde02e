// Every file of the committed corpora through its target: what a fuzzer once found stays found.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>

#include "fuzz/targets.hpp"
#include "paths.hpp"

namespace fpc::fuzz {
namespace fuzz_replay_test {

class Replay : public ::testing::TestWithParam<NamedTarget> {};

TEST_P(Replay, HoldsWhatItPromises) {
  int files = 0;
  const std::string corpus = fpc::sourceDir() + "/test/fuzz/corpus/";
  for (const auto& entry : std::filesystem::directory_iterator(corpus + GetParam().name)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_NO_THROW(GetParam().run(bytes)) << entry.path();
    EXPECT_LE(bytes.size(), 4096U) << entry.path() << ": corpora stay small";
    ++files;
  }
  EXPECT_GE(files, 3);
}

/// Mostly zeros, which change nothing, so that a message is spoilt here and there.
std::string randomBytes(unsigned seed) {
  std::mt19937 engine(seed);
  std::string bytes(engine() % 300, '\0');
  const auto rare = 1 + engine() % 12;
  for (char& byte : bytes)
    if (engine() % rare == 0) byte = static_cast<char>(engine() % 256);
  return bytes;
}

std::string hexOf(const std::string& bytes) {
  std::ostringstream text;
  for (const unsigned char byte : bytes)
    text << std::hex << std::setw(2) << std::setfill('0') << int{byte};
  return text.str();
}

std::vector<NamedTarget> ofDecisions() {
  std::vector<NamedTarget> some;
  for (const NamedTarget& target : targets())
    if (target.decisions) some.push_back(target);
  return some;
}

class RandomDecisions : public ::testing::TestWithParam<NamedTarget> {};

TEST_P(RandomDecisions, HoldWhatTheTargetPromises) {
  const unsigned count = std::getenv("FMBPC_LONG_TESTS") != nullptr ? 50000 : 200;
  for (unsigned seed = 1; seed <= count; ++seed) {
    const std::string bytes = randomBytes(seed);
    ASSERT_NO_THROW(GetParam().run(bytes)) << "seed " << seed << ": " << hexOf(bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

INSTANTIATE_TEST_SUITE_P(Fuzz, RandomDecisions, ::testing::ValuesIn(ofDecisions()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace fuzz_replay_test
}  // namespace fpc::fuzz
