#include "hardware/serial/line_ending.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string errorOf(const std::string& yaml) {
  ConfigReader reader(YAML::Load(yaml), "test");
  std::string end = "kept", text;
  readLineEnding(reader, "end", end);
  readPlainText(reader, "text", text);
  try {
    reader.finish();
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(LineEnding, HasThreeNames) {
  for (const auto& [name, bytes] : {std::pair{"CR", "\r"}, {"LF", "\n"}, {"CRLF", "\r\n"}}) {
    ConfigReader reader(YAML::Load(std::string("{end: ") + name + "}"), "test");
    std::string end = "kept";
    readLineEnding(reader, "end", end);
    reader.finish();
    EXPECT_EQ(end, bytes);
  }
  ConfigReader reader(YAML::Load("{}"), "test");
  std::string end = "kept";
  readLineEnding(reader, "end", end);
  EXPECT_EQ(end, "kept");
}

TEST(LineEnding, OthersAreErrorsThatNameThem) {
  EXPECT_NE(errorOf("{end: crlf}").find("end = crlf: must be one of the names CR, LF, CRLF"), std::string::npos);
  EXPECT_NE(errorOf(R"({end: "\r\n"})").find("and has a carriage return (0x0D)"), std::string::npos);
  EXPECT_NE(errorOf(R"({end: "\n"})").find("and has a line feed (0x0A)"), std::string::npos);
  EXPECT_NE(errorOf(R"({end: ""})").find("must be one of the names"), std::string::npos);
}

TEST(LineEnding, TextHasNoControlCharacters) {
  EXPECT_EQ(errorOf("{text: 'P{pressure} 1~ü'}"), "");
  EXPECT_NE(errorOf(R"({text: "P\r"})").find("text = P\\x0d: has a carriage return (0x0D)"), std::string::npos)
      << errorOf(R"({text: "P\r"})");
  EXPECT_NE(errorOf(R"({text: "P\x7f"})").find("a control character (0x7F)"), std::string::npos);
  EXPECT_NE(errorOf(R"({text: "\tP"})").find("a tabulator (0x09)"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
