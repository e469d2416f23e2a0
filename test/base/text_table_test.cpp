#include "base/text_table.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

using Texts = std::vector<std::string>;

/// Twenty rows of a time (s), a position (um) and a force (nN).
std::string rows(const std::string& separator = ",", const std::string& end = "\n") {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%.3f%s%.3f%s%.3f", 0.1 * i, separator.c_str(), 1.5 * i, separator.c_str(),
                  0.01 * i * i);
    text += line + end;
  }
  return text;
}
std::string withCommas(std::string text) {
  for (char& c : text) c = c == '.' ? ',' : c;
  return text;
}
const std::string kTitles = "time_s,position_um,force_nN\n";

class TextTableTest : public testing::Test {
 protected:
  ~TextTableTest() override { std::remove(path_.c_str()); }

  TextTable read(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return readTextTable(path_);
  }
  std::string refusal(const std::string& bytes) {
    try {
      read(bytes);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  /// It is the table of rows().
  static void expectRows(const TextTable& table, const Texts& titles) {
    ASSERT_EQ(table.columns.size(), 3U);
    ASSERT_EQ(table.rows(), 20U);
    EXPECT_EQ(table.titles(), titles);
    for (int i = 0; i < 20; ++i) {
      EXPECT_NEAR(table.columns[0].values[static_cast<std::size_t>(i)], 0.1 * i, 1e-9);
      EXPECT_NEAR(table.columns[1].values[static_cast<std::size_t>(i)], 1.5 * i, 1e-9);
      EXPECT_NEAR(table.columns[2].values[static_cast<std::size_t>(i)], 0.01 * i * i, 1e-9);
    }
  }
  static bool hasNote(const TextTable& table, const std::string& part) {
    for (const std::string& note : table.notes) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  }

  const std::string path_ = testing::TempDir() + "microinjection_text_table";
  const Texts plain_ = {"time_s", "position_um", "force_nN"};
};

TEST_F(TextTableTest, SeparatorsAndDecimalSigns) {
  expectRows(read(kTitles + rows()), plain_);
  expectRows(read("time_s;position_um;force_nN\n" + rows(";")), plain_);
  expectRows(read("time_s;position_um;force_nN\n" + withCommas(rows(";"))), plain_);
  expectRows(read("time_s\tposition_um\tforce_nN\n" + withCommas(rows("\t"))), plain_);
  expectRows(read("time_s  position_um  force_nN\n" + rows("  ")), plain_);
  expectRows(read("sep=;\ntime_s;position_um;force_nN\n" + rows(";")), plain_);
  expectRows(read("Time (s)   z (um)   F (nN)\n" + rows(" ")), {"Time (s)", "z (um)", "F (nN)"});
}

TEST_F(TextTableTest, QuotesHoldSeparators) {
  std::string quoted;
  for (int i = 0; i < 20; ++i)
    quoted += "\"" + std::to_string(i) + ",5\",\"" + std::to_string(i) + ",25\",\"a \"\"b\"\"\"\n";
  const TextTable table = read("\"time, of day (s)\",x,name\n" + quoted);
  EXPECT_EQ(table.titles(), (Texts{"time, of day (s)", "x", "name"}));
  EXPECT_EQ(table.columns[1].values[3], 3.25);
  EXPECT_EQ(table.columns[2].text, "a \"b\"");
  EXPECT_EQ(table.columns[2].text_line, 2U);
}

TEST_F(TextTableTest, ThousandsAreSeparated) {
  std::string text = "t;x\n", swapped = text;
  for (int i = 0; i < 20; ++i) {
    const std::string number = std::to_string(100 + i);
    text += number + ".5;1,234," + number + ".25\n";
    swapped += number + ",5;1.234." + number + ",25\n";
  }
  for (const std::string& each : {text, swapped}) {
    const TextTable table = read(each);
    EXPECT_EQ(table.columns[1].values[7], 1234107.25);
    EXPECT_EQ(table.columns[0].values[7], 107.5);
  }
}

TEST_F(TextTableTest, ThousandsAreSeparatedAsTypesettersDo) {
  for (const std::string mark : {" ", "'", "\u00A0", "\u2009", "\u2019", "\u202F"}) {
    std::string text = "t;x\n";
    for (int i = 0; i < 20; ++i) text += "0,5;\u22121" + mark + "234" + mark + std::to_string(100 + i) + ",25\n";
    EXPECT_EQ(read(text).columns[1].values[7], -1234107.25) << mark;
  }
}

TEST_F(TextTableTest, DigitsInThreesBesideFewerAreNoDecimals) {
  for (const std::string mark : {",", "."}) {
    const TextTable table = read("t;x\n35;0\n70;990\n1" + mark + "105;1" + mark + "020\n");
    EXPECT_EQ(table.columns[0].values[2], 1105) << mark;
    EXPECT_TRUE(hasNote(table, "'1" + mark + "020' is taken for a number with a separator of thousands"));
  }
  const std::string decimals = "t;x\n1.035;2\n2.070;3\n8;4\n";
  EXPECT_EQ(read(decimals).columns[0].values[1], 2.07);
  EXPECT_NE(refusal(withCommas(decimals)).find("'2,070': the comma may be the decimal sign, or"), std::string::npos);
  EXPECT_NE(refusal("t,x\n\"1,035\",2\n\"1,070\",3\n").find("'1,070': the comma may be"), std::string::npos);
  EXPECT_EQ(read("t;x\n1,035;2,000\n1,070;2,500\n").columns[0].values[1], 1.07);
  EXPECT_EQ(read("t;x\n1.035;2.000\n1.070;2.500\n").columns[0].values[1], 1.07);
}

TEST_F(TextTableTest, TitlesAreFoundWhereTheyAre) {
  const TextTable preamble = read("Force curve\nSpring constant,0.05,0.02\nRate,10\n\n" + kTitles + rows());
  expectRows(preamble, plain_);
  EXPECT_EQ(preamble.title_line, 5U);
  EXPECT_EQ(preamble.first_line, 6U);
  const TextTable comment = read("# instrument X\n# time_s position_um force_nN\n" + rows(" "));
  expectRows(comment, plain_);
  EXPECT_TRUE(hasNote(comment, "last comment"));
  expectRows(read("# columns: time x f\n# units: s um nN\n" + rows(" ")), {"time (s)", "x (um)", "f (nN)"});
  expectRows(read("time,x,f\ns,[um],(nN)\n" + rows()), {"time (s)", "x ([um])", "f ((nN))"});
  expectRows(read("#\n# columns: time x f\n#\n" + rows(" ")), {"time", "x", "f"});
  expectRows(read("time\u00A0(s),x,f\n" + rows()), {"time (s)", "x", "f"});
  EXPECT_TRUE(hasNote(read("1,2,3\n4,5,6\n" + kTitles + rows()), "line 4: 2 rows of numbers before it are left out"));
  const TextTable none = read(rows());
  expectRows(none, {"", "", ""});
  EXPECT_EQ(none.title_line, 0U);
  expectRows(read(kTitles + rows(",", ",\n")), plain_);
  expectRows(read("time_s,position_um,force_nN,\n" + rows(",", ",\n")), plain_);
}

TEST_F(TextTableTest, EncodingsAndEndsOfLines) {
  expectRows(read(kTitles + rows(",", "\r\n")), plain_);
  expectRows(read("time_s,position_um,force_nN\r" + rows(",", "\r")), plain_);
  expectRows(read("\xEF\xBB\xBF" + kTitles + rows()), plain_);
  const TextTable latin = read("time_s,position (\xB5m),force_nN\n" + rows());
  expectRows(latin, {"time_s", "position (\xC2\xB5m)", "force_nN"});
  EXPECT_TRUE(hasNote(latin, "Latin-1"));
  for (const bool big_endian : {false, true}) {
    for (const bool mark : {false, true}) {
      std::string wide = mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
      for (const char c : kTitles + rows()) {
        if (big_endian) wide += '\0';
        wide += c;
        if (!big_endian) wide += '\0';
      }
      expectRows(read(wide), plain_);
    }
  }
}

TEST_F(TextTableTest, CompressedFiles) {
  const gzFile file = ::gzopen(path_.c_str(), "wb");
  const std::string text = kTitles + rows();
  ASSERT_GT(::gzwrite(file, text.data(), static_cast<unsigned>(text.size())), 0);
  ::gzclose(file);
  expectRows(readTextTable(path_), plain_);
  std::ifstream in(path_, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(refusal(bytes.substr(0, bytes.size() / 2)).find("damaged"), std::string::npos);
}

TEST_F(TextTableTest, TimesOfTheDay) {
  std::string text = "time,x\n";
  for (int i = 0; i < 20; ++i) {
    char line[60];
    std::snprintf(line, sizeof line, "%02d:%02d:%06.3f,%d.5\n", i < 10 ? 23 : 0, i < 10 ? 59 : 0,
                  i < 10 ? 50.5 + i : i - 10 + 0.5, i);
    text += line;
  }
  TextTable table = read(text);
  EXPECT_TRUE(table.columns[0].clock);
  EXPECT_NEAR(table.columns[0].values[19], 19, 1e-9) << "over midnight";
  text = "time,x\n";
  for (int i = 0; i < 20; ++i)
    text += "2024-0" + std::to_string(i < 10 ? 2 : 3) + "-" + (i < 10 ? "29" : "01") + "T12:00:00," +
            std::to_string(i) + "\n";
  table = read(text);
  EXPECT_NEAR(table.columns[0].values[19], 86400, 1e-6) << "a leap year";
}

TEST_F(TextTableTest, TimesOfTheDayAsTheyAreWritten) {
  const std::vector<Texts> kTimes = {{"59:59.5", "60:00.5"},
                                     {"11:59:59.5 am", "12:00:00.5 PM"},
                                     {"11:59:59.5 PM", "12:00:00.5 AM"},
                                     {"31.01.2024 23:59:59.5", "01.02.2024 00:00:00.5"},
                                     {"1/31/2024 23:59:59.5", "2/1/2024 00:00:00.5"},
                                     {"2024-01-31T23:59:59.5+01:00", "2024-02-01T00:00:00.5+01:00"}};
  for (const Texts& times : kTimes) {
    const TextTable table = read("time,x,y\n" + times[0] + ",1,2\n" + times[1] + ",2,3\n");
    EXPECT_TRUE(table.columns[0].clock) << times[0];
    EXPECT_NEAR(table.columns[0].values[1], 1, 1e-6) << times[0];
  }
}

TEST_F(TextTableTest, CellsThatAreNoNumbersAreNone) {
  const TextTable table = read("t,x,segment\n1,2,approach\nnan,3,approach\n,4,retract\n5,n/a,retract\n");
  EXPECT_EQ(table.rows(), 4U);
  EXPECT_EQ(table.columns[0].numbers, 2U);
  EXPECT_TRUE(std::isnan(table.columns[0].values[1]));
  EXPECT_TRUE(std::isnan(table.columns[1].values[3]));
  EXPECT_EQ(table.columns[0].text, "");
  EXPECT_EQ(table.columns[2].text, "approach");
}

TEST_F(TextTableTest, ColumnsOfTextsAndCellsThatAreEmptyAtFirst) {
  std::string text = "time_s,phase,depth_m,force_N,state\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i) + (i < 40 ? ",approach,," : ",,1e-6,") + std::to_string(2 * i) + ",idle\n";
  const TextTable table = read(text);
  EXPECT_EQ(table.rows(), 100U);
  EXPECT_EQ(table.title_line, 1U);
  EXPECT_EQ(table.columns[2].numbers, 60U);
  EXPECT_EQ(table.columns[1].texts[39], "approach");
  EXPECT_EQ(table.columns[1].texts[40], "");
  EXPECT_EQ(table.columns[4].texts[99], "idle");
  EXPECT_TRUE(table.columns[3].texts.empty());
}

TEST_F(TextTableTest, PartsWithTheirOwnTitles) {
  const TextTable table = read(kTitles + rows() + "\n" + kTitles + rows());
  EXPECT_EQ(table.rows(), 40U);
  EXPECT_EQ(table.parts, (std::vector<std::size_t>{20}));
}

TEST_F(TextTableTest, ALastLineThatIsCutOffIsLeftOut) {
  const TextTable table = read(kTitles + rows() + "2.0,3");
  expectRows(table, plain_);
  EXPECT_TRUE(hasNote(table, "line 22"));
}

TEST_F(TextTableTest, WhatCannotBeReadIsNamedWithItsLine) {
  EXPECT_NE(refusal("").find(", line 1: the file is empty"), std::string::npos);
  EXPECT_NE(refusal("\"\"\n").find("line 1: '\"\"': the file has no row with two numbers"), std::string::npos);
  EXPECT_NE(refusal(kTitles).find("no row with two numbers"), std::string::npos);
  EXPECT_NE(refusal(kTitles + rows() + "1,2,3,4\n" + rows()).find("line 22: has 4 cells, the table has 3"),
            std::string::npos);
  EXPECT_NE(refusal(kTitles + withCommas(rows())).find("line 1: has 3 cells, the rows have 6: a comma cannot be"),
            std::string::npos);
  EXPECT_NE(refusal(withCommas(rows())).find("line 1: a comma cannot be"), std::string::npos);
  EXPECT_NE(
      refusal("a,b,c\n1,0,02,3,04\n2,5,06,7,08\n").find("line 1: has 3 cells, the rows have 5: a comma cannot be"),
      std::string::npos);
  EXPECT_NE(refusal("#\n%\n//\n").find("no row with two numbers"), std::string::npos);
  EXPECT_NE(refusal("a;b;c\n" + rows(";") + withCommas(rows(";"))).find("line 22: the decimal sign is another one"),
            std::string::npos);
  EXPECT_NE(refusal(kTitles + "1,2,3\n" + std::string("4,\0005,6\n", 8)).find("line 3: has a NUL byte"),
            std::string::npos);
  EXPECT_THROW(readTextTable(testing::TempDir()), ConfigError);
  EXPECT_THROW(readTextTable(testing::TempDir() + "is_not_there"), ConfigError);
}

TEST_F(TextTableTest, NamesWithOneNumberEachAreATableWhereTheyAreMeant) {
  const std::string text = "suction (kPa),image\n0.3,cell 1 of 3.png\n0.6,b.png\n,c.png\n";
  EXPECT_NE(refusal(text).find("no row with two numbers"), std::string::npos);
  std::ofstream(path_, std::ios::binary) << text;
  const TextTable table = readTextTable(path_, 1);
  ASSERT_EQ(table.titles(), Texts({"suction (kPa)", "image"}));
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_EQ(table.columns[1].texts, Texts({"cell 1 of 3.png", "b.png", "c.png"}));
  EXPECT_EQ(table.columns[0].values[1], 0.6);
}

}  // namespace
}  // namespace microinjection
