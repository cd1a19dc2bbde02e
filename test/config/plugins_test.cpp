// Libraries with plants and controllers of others: found, loaded, or one clear error.
#include "config/plugins.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fmbpc/plant/plant.hpp"
#include "paths.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace config_plugins_test {

/// Finds the libraries of the build, and the loops of the example.
class Plugins : public LoopFolder {
 protected:
  Plugins() {
    setenv("FMBPC_PLUGIN_PATH", FMBPC_TEST_PLUGINS, 1);
    setenv("FMBPC_CONFIG_PATH", (sourceDir() + "/examples/two_tanks/config").c_str(), 1);
  }
  std::string errorWith(const std::string& plugin) const {
    return errorOf([&] { readLoop(write("p.yaml", smallLoop() + "plugins: [" + plugin + "]\n")); });
  }
};

TEST_F(Plugins, ALoopBringsThePlantAndTheControllerOfItsPackage) {
  const LoopFile loop = readLoop("two_tanks_outflow");
  EXPECT_EQ(loop.controllerType().name, "outflow");
  const auto plants = plantNames();
  EXPECT_EQ(std::count(plants.begin(), plants.end(), "two_tanks"), 1);
  const RunRecord record = runLoop(loop);
  EXPECT_TRUE(record.complete);
  const Measurement& last = record.samples.back().measurement;
  EXPECT_NEAR(last.outputs[1], 1.2, 0.01);
}

TEST_F(Plugins, ATypeSaysWhichSignalsItNeedsAndFollows) {
  const LoopFile loop = readLoop("two_tanks_outflow");
  EXPECT_EQ(loop.plausibility.needs, (std::vector<bool>{false, true, true}));  // h1, h2, the feed
  EXPECT_EQ(loop.guard.lock_outputs, std::vector<Eigen::Index>{1});
}

TEST_F(Plugins, ThePathOfALibraryIsTakenBesideTheLoopFile) {
  std::filesystem::create_symlink(FMBPC_TEST_PLUGINS "/libtwo_tanks.so", folder_ / "link.so");
  write("by_path.yaml", "extends: two_tanks_outflow.yaml\nplugins: [./link.so]\n");
  std::filesystem::copy(sourceDir() + "/examples/two_tanks/config/loop/two_tanks_outflow.yaml",
                        folder_ / "two_tanks_outflow.yaml");
  const std::string resolved = resolveLoop(path("by_path.yaml"));
  EXPECT_NE(resolved.find((folder_ / "link.so").string()), std::string::npos) << resolved;
}

TEST_F(Plugins, AMissingOneNamesTheFoldersThatWereSearched) {
  setenv("CMAKE_PREFIX_PATH", "/some/workspace", 1);
  expectWords(errorWith("nowhere"),
              {"p.yaml:12: plugins", "'nowhere'", "libnowhere.so", FMBPC_TEST_PLUGINS,
               "/some/workspace/lib", "FMBPC_PLUGIN_PATH"});
  expectWords(errorWith("./nowhere.so"), {"p.yaml:12: plugins", "existing library", "nowhere.so"});
  unsetenv("CMAKE_PREFIX_PATH");
  expectWords(errorWith("libtwo_tanks.so"), {"p.yaml:12: plugins", "'two_tanks', without lib"});
  expectWords(errorWith("\"\""), {"p.yaml:12: plugins", "a plugin's name, got ''"});
}

TEST_F(Plugins, WhatIsNoPluginIsSaidSo) {
  write("text.so", "not a library\n");
  expectWords(errorWith("./text.so"), {"p.yaml:12: plugins", "this fmbpc can load", "text.so"});
  for (int again = 0; again < 2; ++again)
    expectWords(errorWith("registers_nothing"),
                {"p.yaml:12: plugins", "registers plants or controllers", "registers_nothing"});
}

// The C library is in every process.
TEST_F(Plugins, ALibraryThatIsMappedAlreadyIsNoPluginByThat) {
  Dl_info info{};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&std::abort), &info), 0);
  std::filesystem::create_symlink(std::filesystem::absolute(info.dli_fname), path("libc_link.so"));
  for (int again = 0; again < 2; ++again)
    expectWords(errorWith("./libc_link.so"),
                {"p.yaml:12: plugins", "registers plants or controllers", "libc_link.so"});
}

TEST_F(Plugins, OneThatRegistersIsRightUnderAnyPathAndWhoeverMappedIt) {
  std::filesystem::create_symlink(FMBPC_TEST_PLUGINS "/libtwo_tanks.so", folder_ / "link.so");
  EXPECT_EQ(errorWith("two_tanks"), "nothing was thrown");
  EXPECT_EQ(errorWith("./link.so"), "nothing was thrown");
  Dl_info core{};  // nobody loads it as a plugin, and it registers all of ours
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&loadPlugin), &core), 0);
  EXPECT_EQ(errorWith(std::filesystem::absolute(core.dli_fname).string()), "nothing was thrown");
}

TEST_F(Plugins, OneThatIsRefusedIsRefusedUnderEveryPath) {
  for (const char* name : {"taken_name", "registers_nothing"}) {
    const std::string link = std::string(name) + "_link.so";
    std::filesystem::create_symlink(std::string(FMBPC_TEST_PLUGINS "/lib") + name + ".so",
                                    folder_ / link);
    EXPECT_NE(errorWith(name), "nothing was thrown");
    expectWords(errorWith("./" + link), {"p.yaml:12: plugins", link});
  }
}

TEST_F(Plugins, OneThatWasBuiltAgainstAnotherFmbpcIsNotLoaded) {
  expectWords(errorWith("other_layout"), {"p.yaml:12: plugins", "built against this fmbpc",
                                          "build it again", "libother_layout.so"});
}

TEST_F(Plugins, ANameThatIsTakenIsRefusedEveryTime) {
  for (int again = 0; again < 2; ++again)
    expectWords(errorWith("taken_name"),
                {"p.yaml:12: plugins", "controller pi", "there already", "libtaken_name.so"});
  EXPECT_NE(controllerType("pi").summary, "not ours");
}

}  // namespace config_plugins_test
}  // namespace fpc
