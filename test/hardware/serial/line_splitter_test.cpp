#include "hardware/serial/line_splitter.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using Lines = std::vector<std::string>;

TEST(LineSplitter, LinesDoNotDependOnHowTheyArrive) {
  const std::string text = "one\r\ntwo\r\r\n\r\nfour\r\n";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    LineSplitter splitter("\r\n", 10);
    Lines lines;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      for (const auto& line : splitter.feed(text.substr(at, piece))) lines.push_back(line);
    }
    EXPECT_EQ(lines, (Lines{"one", "two\r", "", "four"})) << piece;
  }
}

TEST(LineSplitter, DropsAllOfALineThatIsTooLong) {
  const std::string text = "good\r\n" + std::string(1000, 'x') + "\r\nfine\r\n12345678901\r\n1234567890\r\n";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    LineSplitter splitter("\r\n", 10);
    Lines lines;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      for (const auto& line : splitter.feed(text.substr(at, piece))) lines.push_back(line);
    }
    EXPECT_EQ(lines, (Lines{"good", "fine", "1234567890"})) << piece;
    EXPECT_EQ(splitter.tooLong(), 2U) << piece;
  }
}

TEST(LineSplitter, ClearInMidLineDropsItsRest) {
  LineSplitter splitter("\n", 10);
  splitter.feed("begun");
  splitter.clear(true);
  EXPECT_EQ(splitter.feed(" rest\nwhole\n"), Lines{"whole"});
  splitter.feed("begun");
  splitter.clear(false);
  EXPECT_EQ(splitter.feed("whole\n"), Lines{"whole"});
}

}  // namespace
}  // namespace microinjection
