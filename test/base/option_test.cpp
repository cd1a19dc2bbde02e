#include "fmbpc/base/option.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_option_test {

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

/// Some of the values only, and what is kept as a bool.
TEST(Option, TakesTheWordsAtHand) {
  const auto choices = [](const std::string& text, bool flag) {
    YamlSection section = YamlSection::parse(text, "file.yaml");
    readOption(section, "table", flag, {{"holding", false}, {"input", true}});
    section.finish();
    return flag;
  };
  EXPECT_TRUE(choices("table: input", false));
  EXPECT_FALSE(choices("table: holding", true));
  EXPECT_TRUE(choices("", true));
  EXPECT_THROW(choices("table: coil", false), InputError);
  std::optional<Colour> colour;
  YamlSection section = YamlSection::parse("", "file.yaml");
  readOption(section, "colour", colour, {{"none", std::nullopt}, {"green", Colour::kGreen}});
  EXPECT_FALSE(colour.has_value());
  section = YamlSection::parse("colour: green", "file.yaml");
  readOption(section, "colour", colour, {{"none", std::nullopt}, {"green", Colour::kGreen}});
  EXPECT_EQ(colour, Colour::kGreen);
  section = YamlSection::parse("colour: red", "file.yaml");
  EXPECT_THROW(
      readOption(section, "colour", colour, {{"none", std::nullopt}, {"green", Colour::kGreen}}),
      InputError);
}

/// A value that has no word here stays where the key is absent.
TEST(Option, KeepsAValueWithoutAWord) {
  int sign = 0;
  YamlSection section = YamlSection::parse("", "file.yaml");
  readOption(section, "sign", sign, {{"positive", 1}, {"negative", -1}});
  EXPECT_EQ(sign, 0);
}

}  // namespace base_option_test
}  // namespace fpc
