#include "base/files.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace base_files_test {

class FilesTest : public LoopFolder {
 protected:
  std::string textOf(const std::string& name) const {
    std::ifstream stream(path(name));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
};

TEST_F(FilesTest, WhatIsNewAndRegularFilesAreReplacedAtOnce) {
  writeText("one", path("file"));
  writeText("two", path("file"));
  EXPECT_EQ(textOf("file"), "two");
  EXPECT_FALSE(std::filesystem::exists(path("file.partial")));
}

TEST_F(FilesTest, ALinkStaysOneAndItsFileIsReplaced) {
  write("target", "before");
  std::filesystem::create_symlink("target", path("link"));
  std::filesystem::create_symlink("nowhere yet", path("dangling"));
  writeText("after", path("link"));
  writeText("new", path("dangling"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_TRUE(std::filesystem::is_symlink(path("dangling")));
  EXPECT_EQ(textOf("target"), "after");
  EXPECT_EQ(textOf("nowhere yet"), "new");
}

TEST_F(FilesTest, ADeviceStaysOne) {
  writeText("gone", "/dev/null");
  expectWords(errorOf([] { writeText("no room", "/dev/full"); }), {"/dev/full"});
  for (const char* device : {"/dev/null", "/dev/full"})
    EXPECT_TRUE(std::filesystem::is_character_file(device)) << device;
}

TEST_F(FilesTest, AFolderIsRefused) {
  std::filesystem::create_directory(path("folder"));
  expectWords(errorOf([&] { writeText("text", path("folder")); }), {"folder", "a writable file"});
  EXPECT_TRUE(std::filesystem::is_directory(path("folder")));
}

}  // namespace base_files_test
}  // namespace fpc
