#include "session/parameter_tree.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(ParameterTree, MergesMapsKeyByKeyAndReplacesLists) {
  const YAML::Node base = YAML::Load("{a: 1, b: {c: 2, d: [1, 2]}, e: {f: 3}}");
  const YAML::Node more = YAML::Load("{b: {d: [5], g: 6}, e: 7, h: {i: 8}}");
  mergeParameters(base, more);
  EXPECT_EQ(parameterText(base), "a: 1\nb:\n  c: 2\n  d: [5]\n  g: 6\ne: 7\nh:\n  i: 8\n");
  setParameter(base, "h/i", YAML::Node("9"));
  EXPECT_EQ(parameterText(more), "b:\n  d: [5]\n  g: 6\ne: 7\nh:\n  i: 8\n") << "copies";
}

TEST(ParameterTree, FindsAndSetsByPath) {
  YAML::Node map = YAML::Load("{a: {b: 1}}");
  EXPECT_EQ(parameterAt(map, "a/b").Scalar(), "1");
  EXPECT_FALSE(parameterAt(map, "a/c").IsDefined());
  EXPECT_FALSE(parameterAt(map, "a/b/c").IsDefined());
  EXPECT_EQ(map.size(), 1u);
  setParameter(map, "c/d/e", textValue("x"));
  EXPECT_EQ(parameterText(map), "a:\n  b: 1\nc:\n  d:\n    e: x\n");
}

TEST(ParameterTree, ValuesKeepTheirTypeForYaml11) {
  // As rosparam reads it: 56e-6 without a point, or without the sign of its exponent, would be a text.
  const std::pair<const char*, const char*> cases[] = {{"56e-6", "56.0e-6"},
                                                       {"2e5", "2.0e+5"},
                                                       {"1.5e3", "1.5e+3"},
                                                       {"3", "3"},
                                                       {"-0.5", "-0.5"},
                                                       {"'3'", "\"3\""},
                                                       {"true", "true"},
                                                       {"'true'", "\"true\""},
                                                       {"no", "no"},
                                                       {"\"no\"", "\"no\""},
                                                       {"/dev/ttyUSB0", "/dev/ttyUSB0"},
                                                       {"x y z", "\"x y z\""},
                                                       {"012", "012"},
                                                       {"\"012\"", "\"012\""},
                                                       {"1:30", "\"1:30\""},
                                                       {".inf", ".inf"},
                                                       {"[1, a, {b: [2e-6]}]", "[1, a, {b: [2.0e-6]}]"},
                                                       {"{}", "{}"},
                                                       {"\"\"", "\"\""},
                                                       {"~", "null"},
                                                       {"\"a\\\"b\\\\c\\nd\\re\"", "\"a\\\"b\\\\c\\nd\\x0de\""}};
  for (const auto& [text, written] : cases) {
    const YAML::Node map = YAML::Load(std::string("{key: ") + text + "}");
    EXPECT_EQ(parameterText(map), std::string("key: ") + written + "\n") << text;
    EXPECT_EQ(parameterText(YAML::Clone(map)), std::string("key: ") + written + "\n") << text;
    EXPECT_EQ(YAML::Dump(YAML::Load(parameterText(map))["key"]) == "", false);
  }
  EXPECT_EQ(parameterText(YAML::Load("{on: 1, a-b: 2, 3: 4}")), "\"on\": 1\n\"a-b\": 2\n\"3\": 4\n");
}

TEST(ParameterTree, LinesAreWrittenAsTheyAre) {
  for (const std::string& text : {std::string("<a>\n\n  <b/>\n</a>\n"), std::string("a\nb"), std::string("a\n\n"),
                                  std::string(" a\nb"), std::string("a\r\nb"), std::string("\n")}) {
    YAML::Node map(YAML::NodeType::Map);
    setParameter(map, "outer/text", textValue(text));
    setParameter(map, "next", integerValue(1));
    EXPECT_EQ(YAML::Load(parameterText(map))["outer"]["text"].Scalar(), text) << parameterText(map);
    EXPECT_EQ(YAML::Load(parameterText(map))["next"].Scalar(), "1");
  }
  EXPECT_EQ(parameterText(YAML::Load("{a: \"b\\n c\\n\"}"), 2), "  a: |\n    b\n     c\n");
}

TEST(ParameterTree, NumbersAreTheShortestThatReadBack) {
  EXPECT_EQ(numberText(1.2e-5), "1.2e-05");
  EXPECT_EQ(numberText(1e-6), "1.0e-06");
  EXPECT_EQ(numberText(3), "3.0");
  EXPECT_EQ(numberText(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(numberText(2e5), "200000.0");
  EXPECT_EQ(numberText(1e22), "1.0e+22");
}

}  // namespace
}  // namespace microinjection
