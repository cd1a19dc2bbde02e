#include "fmbpc/base/option.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

enum class Colour { kRed, kGreen };
std::vector<std::string> wordsOf(Colour) { return {"red", "green"}; }

Colour read(const std::string& text, Colour colour) {
  YamlSection section = YamlSection::parse(text, "file.yaml");
  readOption(section, "colour", colour);
  section.finish();
  return colour;
}

TEST(Option, IsReadByItsWordAndStaysWithoutOne) {
  EXPECT_EQ(read("colour: red", Colour::kGreen), Colour::kRed);
  EXPECT_EQ(read("colour: green", Colour::kRed), Colour::kGreen);
  EXPECT_EQ(read("", Colour::kGreen), Colour::kGreen);
  EXPECT_EQ(wordOf(Colour::kGreen), "green");
}

TEST(Option, AnotherWordIsAnErrorWithPlaceAndChoices) {
  try {
    read("colour: blue", Colour::kRed);
    ADD_FAILURE() << "blue was accepted";
  } catch (const InputError& e) {
    const std::string error = e.what();
    for (const char* words : {"file.yaml", "colour", "red, green", "blue"})
      EXPECT_NE(error.find(words), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace fpc
