#include "base/config_reader.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string errorsOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ConfigReader, ReadsEveryType) {
  const YAML::Node node =
      YAML::Load("{length: 2e-6, count: 3, on: true, name: needle, shape: disc, at: [1, -2], inner: {x: 4}}");
  ConfigReader reader(node, "test");
  double length = 0, x = 0;
  int count = 0;
  bool on = false;
  std::string name, shape;
  Eigen::VectorXd at(2);
  reader.number("length", length, Range::positive());
  reader.integer("count", count);
  reader.boolean("on", on);
  reader.text("name", name);
  reader.choice("shape", shape, {"disc", "ball"});
  reader.vector("at", at);
  reader.section("inner").number("x", x);
  reader.finish();
  EXPECT_EQ(length, 2e-6);
  EXPECT_EQ(count, 3);
  EXPECT_TRUE(on);
  EXPECT_EQ(name, "needle");
  EXPECT_EQ(shape, "disc");
  EXPECT_EQ(at, Eigen::Vector2d(1, -2));
  EXPECT_EQ(x, 4);
}

TEST(ConfigReader, KeepsDefaultsOfAbsentKeys) {
  ConfigReader reader(YAML::Load("{}"), "test");
  double length = 7, inner = 8;
  reader.number("length", length);
  reader.section("inner").number("x", inner);
  reader.finish();
  EXPECT_EQ(length, 7);
  EXPECT_EQ(inner, 8);
}

TEST(ConfigReader, ReportsAllErrorsAtOnceWithKeyValueAndRange) {
  const std::string text = errorsOf([] {
    ConfigReader reader(YAML::Load("{length: -1, inner: {x: many, y: 1}, shape: cube, at: [1]}"), "file.yaml");
    double number = 0;
    std::string shape;
    Eigen::VectorXd at(2);
    reader.number("length", number, Range::positive());
    reader.number("missing", number, Range::finite(), ConfigReader::kRequired);
    reader.choice("shape", shape, {"disc", "ball"});
    reader.vector("at", at);
    reader.section("inner").number("x", number);
    reader.finish();
  });
  EXPECT_NE(text.find("file.yaml: length = -1: must be a number in (0, inf)"), std::string::npos) << text;
  EXPECT_NE(text.find("file.yaml: missing is missing"), std::string::npos) << text;
  EXPECT_NE(text.find("file.yaml: shape = cube: must be one of: disc, ball"), std::string::npos) << text;
  EXPECT_NE(text.find("file.yaml: at = [1]: must be a list of 2 numbers"), std::string::npos) << text;
  EXPECT_NE(text.find("file.yaml: inner/x = many: must be a number"), std::string::npos) << text;
  EXPECT_NE(text.find("file.yaml: inner/y: unknown key; known here: x"), std::string::npos) << text;
}

TEST(ConfigReader, RefusesUnknownSectionsAndMapsInPlaceOfValues) {
  EXPECT_NE(errorsOf([] { ConfigReader(YAML::Load("{tip: {radius: 1}}"), "f").finish(); }).find("tip: unknown key"),
            std::string::npos);
  EXPECT_NE(errorsOf([] {
              ConfigReader reader(YAML::Load("{tip: 3}"), "f");
              reader.section("tip");
              reader.finish();
            }).find("tip = 3: must be a map"),
            std::string::npos);
}

TEST(ConfigReader, ReadsListsOfMaps) {
  const auto read = [](const char* text, ConfigReader::Presence presence) {
    ConfigReader reader(YAML::Load(text), "f");
    std::vector<double> values;
    for (ConfigReader& item : reader.sections("layers", presence)) {
      item.number("x", values.emplace_back(0), Range::positive(), ConfigReader::kRequired);
    }
    reader.finish();
    return values;
  };
  EXPECT_EQ(read("{layers: [{x: 2}, {x: 1}]}", ConfigReader::kRequired), (std::vector<double>{2, 1}));
  EXPECT_TRUE(read("{}", ConfigReader::kOptional).empty());
  EXPECT_EQ(errorsOf([&] { read("{}", ConfigReader::kRequired); }), "f: layers is missing");
  EXPECT_EQ(errorsOf([&] { read("{layers: {x: 1}}", ConfigReader::kOptional); }),
            "f: layers = {x: 1}: must be a list of maps");
  const std::string text = errorsOf([&] { read("{layers: [{x: -1}, 3, {y: 1}]}", ConfigReader::kOptional); });
  for (const char* part : {"f: layers/0/x = -1: must be a number in (0, inf)", "f: layers/1: must be a map",
                           "f: layers/2/x is missing", "f: layers/2/y: unknown key; known here: x"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
}

TEST(ConfigReader, RefusesKeysThatAreThereTwiceAndRootsThatAreNoMap) {
  EXPECT_NE(errorsOf([] {
              ConfigReader reader(YAML::Load("{diameter: 1, diameter: 2}"), "cell.yaml");
              double diameter = 0;
              reader.number("diameter", diameter);
              reader.finish();
            }).find("diameter: is there twice"),
            std::string::npos);
  EXPECT_NE(errorsOf([] { ConfigReader(YAML::Load("[1, 2]"), "cell.yaml").finish(); }).find("must be a map"),
            std::string::npos);
}

TEST(ConfigReader, RefusesNumbersThatAreNotFinite) {
  for (const char* value : {".nan", ".inf", "-.inf", "1e400", "''"}) {
    EXPECT_NE(errorsOf([&] {
                ConfigReader reader(YAML::Load(std::string("{x: ") + value + "}"), "f");
                double x = 0;
                reader.number("x", x);
                reader.finish();
              }),
              "")
        << value;
  }
}

TEST(ConfigReader, ShowsControlCharactersByTheirCodes) {
  ConfigReader reader(YAML::Load(R"({end: "a\r"})"), "test");
  std::string end;
  reader.text("end", end);
  reader.error("end", "is wrong");
  try {
    reader.finish();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find("\r"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("\\x0d"), std::string::npos) << error.what();
  }
}

TEST(Range, KnowsItsEnds) {
  EXPECT_FALSE(Range::positive().contains(0));
  EXPECT_TRUE(Range::nonNegative().contains(0));
  EXPECT_TRUE(Range::closed(1, 2).contains(2));
  EXPECT_FALSE(Range::open(1, 2).contains(2));
  EXPECT_EQ(Range::open(-1, 0.5).text(), "(-1, 0.5)");
  EXPECT_EQ(Range::nonNegative().text(), "[0, inf)");
}

std::string file(const std::string& text) {
  const std::string path = testing::TempDir() + "config_reader_test.yaml";
  std::ofstream(path) << text;
  return path;
}

TEST(ConfigReader, OfAFileNamesTheLineOfEachError) {
  const std::string path = file("# a session\nname: lathe\nrig:\n  port: [1]\n  speed: 3\n  sped: 3\n");
  ConfigReader reader = ConfigReader::ofFile(path);
  std::string name, port;
  double speed = 0, mass = 0;
  EXPECT_EQ(reader.place("name"), path + ", line 2");
  reader.choice("name", name, {"sim", "zaber"});
  ConfigReader rig = reader.section("rig");
  rig.text("port", port);
  rig.number("speed", speed, Range::closed(0, 1));
  rig.number("mass", mass, Range::finite(), ConfigReader::kRequired);
  EXPECT_EQ(errorsOf([&] { reader.finish(); }), path + ", line 2: name = lathe: must be one of: sim, zaber\n" + path +
                                                    ", line 4: rig/port = [1]: must be text\n" + path +
                                                    ", line 5: rig/speed = 3: must be a number in [0, 1]\n" + path +
                                                    ", line 4: rig/mass is missing\n" + path +
                                                    ", line 6: rig/sped: unknown key; known here: mass, port, speed");
}

TEST(ConfigReader, OfAFileFindsKeysThatAreThereTwiceWhereverTheyAre) {
  const std::string path = file("a: 1\nb:\n  - {c: 1, d: {e: 1}}\n  - c: 1\n    c: 2\na: 2\n");
  const std::string twice = path + ", line 5: b/1/c: is there twice, first in line 4; must be there once\n" + path +
                            ", line 6: a: is there twice, first in line 1; must be there once";
  EXPECT_EQ(errorsOf([&] { loadYamlMap(path); }), twice);
  ConfigReader reader = ConfigReader::ofFile(path);
  reader.any("a");
  EXPECT_TRUE(reader.any("b").IsSequence());
  EXPECT_FALSE(reader.any("nothing").IsDefined());
  EXPECT_EQ(errorsOf([&] { reader.finish(); }), twice);
}

TEST(ConfigReader, OfAFileRefusesValuesWithoutAnEnd) {
  const std::string bomb =
      "a: &a [1,1,1,1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\n"
      "d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\ne: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: [*e,*e,*e,*e,*e,*e,*e,*e,*e]\n";
  for (const std::string& text : {std::string("a: &a {b: *a}\n"), bomb}) {
    const std::string path = file(text);
    EXPECT_NE(errorsOf([&] { ConfigReader::ofFile(path); }).find("has too many values"), std::string::npos) << text;
    EXPECT_NE(errorsOf([&] { loadYamlMap(path); }).find("has too many values"), std::string::npos) << text;
  }
}

/// 010 is 8 in YAML 1.1 and 10 in YAML 1.2.
TEST(ConfigReader, RefusesALeadingZeroWhereverThereIsANumber) {
  const std::string path = file("samples: 010\nlength: 007\nat: [1, -02]\ndepths: [+03]\ngood: [0, 0.10, 0e1, -0]\n");
  ConfigReader reader = ConfigReader::ofFile(path);
  int samples = 1;
  double length = 0;
  Eigen::VectorXd at(2), good(4);
  std::vector<double> depths;
  reader.integer("samples", samples);
  reader.number("length", length);
  reader.vector("at", at);
  reader.numbers("depths", depths);
  reader.vector("good", good);
  const std::string text = errorsOf([&] { reader.finish(); });
  for (const char* part : {", line 1: samples = 010: must be written without the leading zero",
                           "line 2: length = 007: ", "line 3: at = [1, -02]: ", "line 4: depths = [+03]: "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  EXPECT_EQ(text.find("good"), std::string::npos) << text;
  EXPECT_EQ(samples, 1);
}

TEST(ConfigReader, NamesCharactersThatOnlyLookLikeABlankOrAMinus) {
  const std::string path = file(
      "length: 6e-6\xc2\xa0\nsize: 6e\xe2\x88\x92"
      "6\n\xc2\xa0width: 1\n");
  ConfigReader reader = ConfigReader::ofFile(path);
  double length = 0;
  reader.number("length", length);
  reader.number("size", length);
  const std::string text = errorsOf([&] { reader.finish(); });
  for (const char* part :
       {", line 1: length = 6e-6<no-break space U+00A0>: must be a number",
        "line 2: size = 6e<minus sign U+2212>6: must be a number", "line 3: <no-break space U+00A0>width: unknown key"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(LoadYamlMap, NamesTheCharacterThatMakesAFileNoYaml) {
  const auto refused = [](const std::string& text) {
    const std::string path = file(text);
    return errorsOf([&] { loadYamlMap(path); });
  };
  EXPECT_NE(refused("cell:\n\tdiameter: 6e-5\n  a: 1\n").find("; line 2 begins with a tab"), std::string::npos);
  EXPECT_NE(refused("cell:\n  diameter:\xc2\xa0"
                    "6e-5\n  a: 1\n")
                .find("; line 2 has a no-break space U+00A0"),
            std::string::npos);
  EXPECT_EQ(refused("# 6\xc2\xa0um\ncell: [\n").find("no-break"), std::string::npos) << "a comment may have it";
}

TEST(ConfigReader, APathOfANodeIsAbsoluteOrFromTheHomeFolder) {
  ConfigReader reader(YAML::Load("{absolute: /data/cell.yaml, home: ~/today, none: '', relative: today, "
                                 "above: ../today, nothing: '', list: [a]}"),
                      "node");
  std::string absolute, home, none = "before", relative = "before", above, nothing, list, absent = "default";
  reader.path("absolute", absolute);
  reader.path("home", home);
  reader.path("none", none);
  reader.path("absent", absent);
  EXPECT_EQ(absolute, "/data/cell.yaml");
  EXPECT_EQ(home, std::string(std::getenv("HOME")) + "/today");
  EXPECT_EQ(none, "");
  EXPECT_EQ(absent, "default");
  reader.path("relative", relative);
  reader.path("above", above);
  reader.path("nothing", nothing, ConfigReader::kRequired);
  reader.path("list", list);
  EXPECT_EQ(relative, "before");
  const std::string text = errorsOf([&] { reader.finish(); });
  for (const char* part : {"relative = today: must be an absolute path, or begin with ~/", "above = ../today: must be",
                           "nothing = ", "list"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(LoadYamlMap, NamesTheFile) {
  EXPECT_NE(errorsOf([] { loadYamlMap("/no/such.yaml"); }).find("/no/such.yaml: cannot be read"), std::string::npos);
  const std::string path = testing::TempDir() + "bad.yaml";
  std::ofstream(path) << "a: [1, 2\nb: }";
  EXPECT_NE(errorsOf([&] { loadYamlMap(path); }).find(path), std::string::npos);
  std::ofstream(path) << "- 1\n- 2\n";
  EXPECT_NE(errorsOf([&] { loadYamlMap(path); }).find("must be a YAML map"), std::string::npos);
  EXPECT_EQ(errorsOf([] { loadYamlMap("/tmp"); }), "/tmp: is a directory; must be a YAML file");
}

}  // namespace
}  // namespace microinjection
